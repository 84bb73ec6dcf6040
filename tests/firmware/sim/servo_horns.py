"""The servos of the arm: the board's pulses turned into joint angles of the MuJoCo rover."""

from tests.firmware.sim.mujoco_plant import MujocoPlant
from tests.firmware.sim.rover import Rover

from tapreach.drivers.arduino.servos import ServoMap
from tapreach.drivers.sim.world import CLAW_RAD_PER_METRE
from tapreach.robot.arm_section import ArmSection

DEAD_BAND_US = 4.0
"""A smaller change of its pulse does not make a servo move; interrupts let the pulses waver by about 2 µs."""


class ServoHorns:
    """`follow` as often as pulses come; a servo that never had a pulse stays where it was put."""

    def __init__(self, rover: Rover, plant: MujocoPlant, arm: ArmSection) -> None:
        self._rover, self._plant = rover, plant
        self._servos = ServoMap(arm).servos
        stowed = arm.stowed.pose()
        rest = (stowed.rotation, stowed.shoulder, stowed.elbow, stowed.claw)
        self._at_us = [s.zero_us + s.us_per_unit * value for s, value in zip(self._servos, rest, strict=True)]

    def follow(self) -> None:
        """Hand the joints what the pulses say."""
        for index, pin in enumerate(self._rover.wiring.servos):
            pulse_us = self._rover.avr.pulse_us(pin)
            if pulse_us and abs(pulse_us - self._at_us[index]) > DEAD_BAND_US:
                self._at_us[index] = pulse_us
        a, b, c, d = (s.value(at) for s, at in zip(self._servos, self._at_us, strict=True))
        self._plant.move_servos((a, b, c, d * CLAW_RAD_PER_METRE))
