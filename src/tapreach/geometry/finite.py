"""Checks that keep NaN, infinity and impossible sizes out of the geometry."""

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tapreach.errors import InputError

FloatArray = npt.NDArray[np.float64]


def finite(name: str, value: float) -> float:
    """Return `value` as a float. Raises InputError where it is not a finite number."""
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name} is {value!r}; it must be a finite number") from None
    if not math.isfinite(number):
        raise InputError(f"{name} is {number}; it must be a finite number")
    return number


def positive(name: str, value: float) -> float:
    """Return `value` as a float. Raises InputError where it is not finite and greater than zero."""
    number = finite(name, value)
    if number <= 0.0:
        raise InputError(f"{name} is {number:g}; it must be greater than 0")
    return number


def not_negative(name: str, value: float) -> float:
    """Return `value` as a float. Raises InputError where it is not finite or is below zero."""
    number = finite(name, value)
    if number < 0.0:
        raise InputError(f"{name} is {number:g}; it must be 0 or greater")
    return number


def finite_array(name: str, value: npt.ArrayLike, shape: Sequence[int | None]) -> FloatArray:
    """Return `value` as a float64 array of `shape`, where None stands for any length.

    Raises InputError naming the shape or the first entry that is not finite.
    """
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name} cannot be read as an array of numbers") from None
    expected = tuple("n" if length is None else length for length in shape)
    fits = array.ndim == len(shape) and all(
        want is None or want == have for want, have in zip(shape, array.shape, strict=True)
    )
    if not fits:
        raise InputError(f"{name} has shape {array.shape}; it must have shape {expected}".replace("'", ""))
    if not np.all(np.isfinite(array)):
        where = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise InputError(f"{name} holds {array[where]} at index {where}; all entries must be finite")
    return array
