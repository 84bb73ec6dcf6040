"""The worker process of `compute.ComputeProcess`: reads calls from its parent, answers them, dies with it.

Started as `python -m tapreach.tasks.compute_worker`. Calls and answers are pickles with their length before
them, on a private copy of stdin and stdout: whatever a library prints goes to stderr. Only its own parent
writes to it.
"""

import ctypes
import os
import pickle
import signal
import struct
import sys
from typing import BinaryIO

LENGTH = struct.Struct("<Q")
_PR_SET_PDEATHSIG = 1


def main() -> None:
    """Serve until the parent closes its end or dies."""
    parent = os.getppid()
    die_with_parent()
    if os.getppid() != parent:
        return
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the whole group; the parent decides.
    calls, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    try:
        serve(calls, answers)
    except BrokenPipeError:
        os._exit(0)  # the parent has gone in the middle of an answer: nobody is left to tell


def die_with_parent() -> None:
    """Have Linux kill this process when its parent dies; elsewhere the end of the pipe does it, a
    little later.
    """
    if sys.platform == "linux":
        ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)


def serve(calls: BinaryIO, answers: BinaryIO) -> None:
    """Answer every call (id, function, arguments) with (id, is_result, value); return at the end of
    `calls`.
    """
    while (blob := read_blob(calls)) is not None:
        answers.write(answer_to(blob))
        answers.flush()


def read_blob(stream: BinaryIO) -> bytes | None:
    """Return the next pickle, None at the end."""
    header = stream.read(LENGTH.size)
    if len(header) < LENGTH.size:
        return None
    (length,) = LENGTH.unpack(header)
    blob = stream.read(length)
    return blob if len(blob) == length else None


def with_length(value: object) -> bytes:
    """Return `value` as a pickle with its length before it."""
    blob = pickle.dumps(value, protocol=pickle.HIGHEST_PROTOCOL)
    return LENGTH.pack(len(blob)) + blob


def answer_to(blob: bytes) -> bytes:
    """Run one call. Errors are answers too, and one that cannot be pickled is told as text."""
    call_id = 0
    try:
        call_id, function, arguments = pickle.loads(blob)
        return with_length((call_id, True, function(*arguments)))
    except Exception as error:
        return with_length((call_id, False, _portable(error)))


def _portable(error: Exception) -> Exception:
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


if __name__ == "__main__":
    main()
