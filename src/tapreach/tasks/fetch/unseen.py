"""What is lost from sight and was doubtful when it was last measured: unseen, nothing settles it."""

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
    judged = judge(thing.size, claw)
    if judged.verdict is Verdict.YES or not (judged.from_another_side or thing.size.foot > OFF_FLOOR):
        return ""
    return f"{judged.reason}; it cannot be looked at from elsewhere: {loss}"
