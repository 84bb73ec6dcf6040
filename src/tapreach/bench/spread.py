"""Independent pieces of work over one or more processes."""

import multiprocessing
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from typing import TypeVar

from tapreach.tasks.compute_worker import die_with_parent

Task = TypeVar("Task")
Result = TypeVar("Result")


def spread(function: Callable[[Task], Result], tasks: Sequence[Task], jobs: int) -> list[Result]:
    """Return the results in the order of the tasks. Function and tasks must pickle for more than one job."""
    if jobs <= 1:
        return [function(task) for task in tasks]
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, spawn, initializer=die_with_parent) as pool:
        return list(pool.map(function, tasks))
