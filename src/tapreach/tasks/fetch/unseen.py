"""What is lost from sight and was doubtful when it was last measured: unseen, nothing settles it."""

from tapreach.tasks.fetch.believed_size import WIDTH_TOLD
from tapreach.tasks.fetch.claw_room import Claw
from tapreach.tasks.fetch.reach import OFF_FLOOR, Verdict, judge
from tapreach.tasks.fetch.thing import NoSize, Thing


def refused_unseen(thing: Thing, claw: Claw, loss: str) -> str:
    """Return why a thing that was lost (`loss` tells how, '' for a thing in sight) is not driven at; '' where
    it is.

    Only what no better known width would settle: it hangs or stands on something, or is too wide from here.
    """
    if not loss or isinstance(thing.size, NoSize):
        return ""
    judged, is_told = judge(thing.size, claw), not thing.size.by_picture or thing.size.told >= WIDTH_TOLD
    is_too_wide = judged.from_another_side and is_told
    if judged.verdict is Verdict.YES or not (is_too_wide or thing.size.foot > OFF_FLOOR):
        return ""
    return f"{judged.reason}; it cannot be looked at from elsewhere: {loss}"
