"""Requests that move the wheels or the arm, or decide who may."""

from tapreach.control.arm_jog import jogged
from tapreach.control.deadman import Wish
from tapreach.control.gate import command_refusal, picture_refusal, refusal
from tapreach.errors import FrameError, LinkLost
from tapreach.robot.messages import ArmPose, Twist
from tapreach.server.message_base import Request, Timed
from tapreach.server.messages import (
    Ack,
    ArmGoto,
    ArmStep,
    Drive,
    EmergencyReset,
    EmergencyStop,
    Heartbeat,
    LeaseAnswer,
    LeaseRelease,
    LeaseRequest,
    Stop,
)
from tapreach.server.station import Station
from tapreach.server.views import twist_view
from tapreach.server.visitor import Visitor


class DrivingRequests:
    """Each method answers one kind of request; none of them waits."""

    def __init__(self, station: Station) -> None:
        self._station = station

    def heartbeat(self, visitor: Visitor, request: Heartbeat) -> Ack:
        """The operator is there."""
        reason = self._unfit(visitor, request)
        if not reason:
            self._station.deadman.heard()
        return _ack(request, reason)

    def drive(self, visitor: Visitor, request: Drive) -> Ack:
        """Take the wish and pass it on at once; what the gate refuses is not held."""
        station = self._station
        reason = self._unfit(visitor, request)
        if reason:
            return _ack(request, reason)
        station.deadman.heard()
        station.lease.command_given(visitor.session_id)
        captured_ns, reason = self._picture(request)
        reason = reason or self._forbidden(visitor) or picture_refusal(captured_ns, station.clock.now_ns())
        if reason:
            return self._ack_sent(request, station.loop.stop(reason), reason, ok=False)
        twist = Twist(request.linear, request.angular)
        if not twist.is_zero:
            station.loop.refuse_task("the operator drives")
        station.deadman.hold(Wish(twist, captured_ns))
        return self._ack_sent(request, station.loop.act(), station.loop.sent.limited_by)

    def stop(self, visitor: Visitor, request: Stop) -> Ack:
        """Zero now, and the end of a running task."""
        if not self._station.lease.is_held_by(visitor.session_id):
            return _ack(request, "you do not drive; the emergency stop works for everybody")
        twist = self._station.loop.stop(f"stopped ({request.reason})")
        return self._ack_sent(request, twist, self._station.loop.sent.limited_by)

    def emergency_stop(self, visitor: Visitor, request: EmergencyStop) -> Ack:
        """Latch, and say what was really done."""
        station = self._station
        station.emergency_stop.press(visitor.name)
        twist = station.loop.stop(f"emergency stop {station.emergency_stop.text}")
        failed = station.loop.sent.limited_by
        done = f"not confirmed by the robot: {failed}" if failed else "wheels sent zero, arm told to hold"
        return self._ack_sent(request, twist, done, ok=not failed)

    def emergency_reset(self, visitor: Visitor, request: EmergencyReset) -> Ack:
        """Unlatch; moving again needs a fresh command."""
        if not self._station.lease.is_held_by(visitor.session_id):
            return _ack(request, "only who drives can reset the emergency stop: ask to drive first")
        self._station.emergency_stop.reset()
        return _ack(request)

    def arm_step(self, visitor: Visitor, request: ArmStep) -> Ack:
        """One press of an arm control, from where the arm was last sent."""
        present = self._station.loop.arm_target
        if present is None:
            return _ack(request, "the arm has not reported yet")
        section = self._station.robot.description.arm
        target = jogged(present, request.control, request.step_deg, section)
        if target == present:
            return _ack(request, f"{request.control}: the arm is at its limit")
        return self._move_arm(visitor, request, target)

    def arm_goto(self, visitor: Visitor, request: ArmGoto) -> Ack:
        """Send the arm to a named pose."""
        arm = self._station.robot.description.arm
        pose = arm.standard if request.pose == "standard" else arm.stowed
        return self._move_arm(visitor, request, pose.pose())

    def lease_request(self, visitor: Visitor, request: LeaseRequest) -> Ack:
        """Ask to drive."""
        return _ack(request, self._station.lease.request(visitor.session_id).reason)

    def lease_release(self, visitor: Visitor, request: LeaseRelease) -> Ack:
        """Give the lease back, or withdraw the ask."""
        self._station.lease.leave(visitor.session_id)
        return _ack(request)

    def lease_answer(self, visitor: Visitor, request: LeaseAnswer) -> Ack:
        """The holder grants or refuses."""
        reply = self._station.lease.answer(visitor.session_id, request.session_id, request.grant)
        return _ack(request, reply.reason)

    def _move_arm(self, visitor: Visitor, request: Timed, target: ArmPose) -> Ack:
        station = self._station
        reason = self._unfit(visitor, request)
        if reason:
            return _ack(request, reason)
        station.deadman.heard()
        station.lease.command_given(visitor.session_id)
        reason = self._forbidden(visitor)
        if reason:
            return _ack(request, reason)
        station.loop.refuse_task("the operator moves the arm")
        try:
            station.loop.move_arm(target)
        except LinkLost as error:
            return _ack(request, str(error))
        return _ack(request)

    def _unfit(self, visitor: Visitor, request: Timed) -> str:
        """Why this message is no sign of an operator: too old, or from somebody who does not drive."""
        age_ns = visitor.alignment.age_ns(request.client_ms, self._station.clock.now_ns())
        if not self._station.lease.is_held_by(visitor.session_id):
            return "you do not have the lease: ask to drive first"
        return command_refusal(age_ns)

    def _forbidden(self, visitor: Visitor) -> str:
        return refusal(self._station.authority.circumstances_of(visitor.session_id))

    def _picture(self, request: Timed) -> tuple[int | None, str]:
        if request.frame_id is None:
            return None, ""
        try:
            return self._station.frames.get(request.frame_id).captured_ns, ""
        except FrameError as error:
            return None, str(error)

    def _ack_sent(self, request: Request, twist: Twist, reason: str = "", ok: bool = True) -> Ack:
        return Ack(seq=request.seq, ok=ok, reason=reason, sent=twist_view(twist))


def _ack(request: Request, refused: str = "") -> Ack:
    return Ack(seq=request.seq, ok=not refused, reason=refused)
