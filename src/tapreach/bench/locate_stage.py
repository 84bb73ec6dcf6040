"""The taps of the bench of locating: any thing of the scene, any place on it; see `places`."""

from tapreach.bench.fault_level import LOCATING
from tapreach.bench.locate_plan import generator, scene_of
from tapreach.bench.places import things_of
from tapreach.bench.stage import Setting, Stage, draw_in


async def draw_stage(seed: int, number: int, rate_hz: float) -> Stage:
    """Return the tap with this number. Raises SetupError when the scene shows nothing that can be tapped."""
    name, scene = scene_of(seed, number)
    setting = Setting(number, name, scene, LOCATING, rate_hz)
    return await draw_in(setting, things_of(scene), generator(seed, number))
