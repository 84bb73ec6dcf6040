"""What was found, offered for the robot file."""

from pathlib import Path

from tapreach.cli.teaching.file_changes import Changes, changed_text, difference, write_text
from tapreach.cli.teaching.person import Person


async def offer_changes(person: Person, path: Path, changes: Changes) -> bool:
    """Show how the robot file would change, and write it on the person's word; False where there is none.

    Raises ConfigError where it would be no robot file, TeachingStopped.
    """
    before = path.read_text(encoding="utf-8")
    after = changed_text(before, changes, str(path))
    if after == before:
        person.tell("\nThe robot file says so already.")
        return True
    person.tell("\n" + difference(before, after, path.name))
    if await person.ask("Write this?", ("yes", "no")) == "no":
        return False
    write_text(path, after)
    person.tell(f"Written to {path}.")
    return True
