"""Taking what is followed as tapped anew, where it is seen much larger than it was tapped.

What was tapped from far is a few pixels, which fit many places of what they are part of: the place slides
over the thing while the robot drives up to it, as if it were ever a little farther away. Seen from near it is
held well; and which spot of the thing it is does not matter to the claw. Only further views in which it is
seen tell its distance as well as the old ones did.
"""

from tapreach.tasks.fetch.looking_again import keep_what_is_known, still_followed
from tapreach.tasks.fetch.run import FetchRun
from tapreach.tasks.follower import Follower
from tapreach.tasks.locating import Locating
from tapreach.tasks.target import TargetSource
from tapreach.tasks.target_report import TargetReport
from tapreach.tasks.task import Tap

GROWN = 2.0
"""Seen so many times larger than where it was tapped it is taken as tapped anew."""
ANOTHER_SPOT_SD = 0.02
"""How far the place may have slid over the thing, one sigma of each coordinate [m], besides what is known of
it: what slid has told a wrong distance as well.
"""
_PLACE_COUNTS = 2.0
"""The sigmas of what the earlier views tell count so many times."""


def has_grown(run: FetchRun) -> bool:
    """Tell whether the thing is followed, without a doubt, and seen much larger than it was tapped."""
    follower = run.locating.follower if run.locating is not None else None
    if follower is None or follower.loss or follower.doubt or not follower.sightings:
        return False
    return follower.last.scale >= GROWN * follower.sightings[0].scale


async def follow_from_here(run: FetchRun, accuracy: float) -> None:
    """Go on with a tracker that begins where the place is followed now; what was known tells the distance
    until the new views know better. Where that is too little for a position all stays as it was.
    """
    keep_what_is_known(run)
    tap, known, before = still_followed(run), run.memory.known, run.locating
    if tap is None or known is None or before is None:
        return
    locating = _begun_at(run, tap, ~before.follower.key, accuracy)
    place = known.place.less_sure(_PLACE_COUNTS).perhaps_moved(ANOTHER_SPOT_SD, ANOTHER_SPOT_SD)
    await locating.recall(place)
    await locating.begin()
    is_placed = locating.estimate is not None and locating.estimate.point_in_world is not None
    await (before if is_placed else locating).follower.close()
    run.locating = locating if is_placed else before


def _begun_at(run: FetchRun, tap: Tap, key: int, accuracy: float) -> Locating:
    context, before = run.context, run.locating
    report = TargetReport(run.memory.target_id, TargetSource.LOCATE, tap, context.description)
    follower = Follower(context, tap, key=key, uses_background=run.ways.use_background)
    locating = Locating(context, follower, report, accuracy)
    locating.keep_clear = before.keep_clear if before is not None else ()
    return locating
