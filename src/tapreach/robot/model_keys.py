"""Which keys a nested pydantic model knows at a place, for messages that teach."""

from collections.abc import Iterator
from typing import Annotated, Any, Literal, get_args, get_origin

from pydantic import BaseModel


def known_keys(model: type[BaseModel], loc: tuple[str | int, ...]) -> list[str]:
    """Return the sorted keys that `model` accepts at the pydantic error location `loc`; empty if none."""
    annotation: Any = model
    for part in loc:
        annotation = _step(annotation, part)
    return sorted({field for found in _models_in(annotation) for field in found.model_fields})


def _step(annotation: Any, part: str | int) -> Any:
    models = list(_models_in(annotation))
    for model in models:
        if isinstance(part, str) and part in model.model_fields and not _is_sequence(annotation):
            return model.model_fields[part].annotation
    tagged = [model for model in models if part in _tags(model)]
    return tagged[0] if tagged else annotation if isinstance(part, str) else _element(annotation)


def _is_sequence(annotation: Any) -> bool:
    return get_origin(_plain(annotation)) in (list, tuple)


def _element(annotation: Any) -> Any:
    args = get_args(_plain(annotation))
    return args[0] if args else annotation


def _plain(annotation: Any) -> Any:
    return get_args(annotation)[0] if get_origin(annotation) is Annotated else annotation


def _tags(model: type[BaseModel]) -> set[Any]:
    fields = model.model_fields.values()
    return {tag for f in fields if get_origin(f.annotation) is Literal for tag in get_args(f.annotation)}


def _models_in(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for inner in get_args(annotation):
        yield from _models_in(inner)
