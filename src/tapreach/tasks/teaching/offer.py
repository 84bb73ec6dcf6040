"""What was found, offered for the robot file."""

import asyncio
from pathlib import Path

from tapreach.errors import InputError
from tapreach.tasks.teaching.file_changes import Changes, changed_text, difference, write_text
from tapreach.tasks.teaching.person import Person


async def offer_changes(person: Person, path: Path, changes: Changes) -> bool:
    """Show how the robot file would change, and write it on the person's word; False where there is none.

    Raises ConfigError where it would be no robot file, InputError where it was changed meanwhile,
    TeachingStopped.
    """
    before = path.read_text(encoding="utf-8")
    # Reading TOML with its comments takes longer than a control period may.
    after = await asyncio.to_thread(changed_text, before, changes, str(path))
    if after == before:
        person.tell("The robot file says so already.")
        return True
    person.show_change(difference(before, after, path.name))
    if await person.ask("Write this?", ("yes", "no")) == "no":
        return False
    if path.read_text(encoding="utf-8") != before:
        raise InputError(f"{path.name} was changed by somebody else meanwhile; nothing was written")
    write_text(path, after)
    person.tell(f"Written to {path}.")
    return True
