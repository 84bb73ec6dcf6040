"""What a lesson has found out, before anything is written."""

from dataclasses import dataclass, field

from tapreach.tasks.teaching.file_changes import Changes


@dataclass(frozen=True, slots=True)
class Finding:
    """to_wire: what has to be wired otherwise, and then nothing is written. words: said before the change.
    changes: what the robot file should say. if_written, if_not: what to do after it was, or was not.
    """

    to_wire: tuple[str, ...] = ()
    words: str = ""
    changes: Changes = field(default_factory=dict)
    if_written: str = ""
    if_not: str = ""
