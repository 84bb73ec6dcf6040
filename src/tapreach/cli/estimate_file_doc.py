"""Writes docs/estimate-file.md: `python -m tapreach.cli.estimate_file_doc > docs/estimate-file.md`."""

import sys
from typing import Any

from tapreach.cli.estimate_file import EstimateFile

_HEAD = """# The file of `tapreach estimate`

Generated from the validated model in `src/tapreach/cli/estimate_file.py`; `tapreach estimate --schema`
prints it as JSON schema. Lengths in metres, angles in radians, pixels with (0, 0) in the centre of the
top-left pixel. Unknown keys, NaN and infinity are errors. Taps on two pictures with a step between:

```json
{
  "cameras": {"front": {"width": 640, "height": 480, "fx": 600, "fy": 600, "cx": 319.5, "cy": 239.5}},
  "mount": {"position": [0.1, 0, 0.15], "pitch": 0.1745},
  "odometry": {"advance_fraction": 0.01, "turn_fraction": 0.01},
  "views": [
    {"camera": "front", "pixel": [319.5, 269.5], "sigma_px": 1},
    {"camera": "front", "pixel": [491.6, 307.8], "sigma_px": 1, "step": {"turn": 0.2094, "advance": 0.2}}
  ]
}
```
"""


def markdown() -> str:
    """Return the whole document."""
    schema = EstimateFile.model_json_schema()
    parts = {"the file": schema} | schema["$defs"]
    return _HEAD + "".join(_section(name, part) for name, part in parts.items())


def _section(name: str, part: dict[str, Any]) -> str:
    required = part.get("required", [])
    rows = [
        f"| `{key}` | {_kind(value)} | {'required' if key in required else _default(value)} |\n"
        for key, value in part["properties"].items()
    ]
    title = name.removesuffix("Part") if name != "the file" else "The file"
    text = " ".join(part.get("description", "").split())
    return f"\n## {title}\n\n{text}\n\n| key | value | default |\n|---|---|---|\n" + "".join(rows)


def _kind(value: dict[str, Any]) -> str:
    if "$ref" in value:
        return str(value["$ref"]).rsplit("/", 1)[-1].removesuffix("Part")
    if "anyOf" in value:
        return " or ".join(_kind(each) for each in value["anyOf"] if each.get("type") != "null")
    if "prefixItems" in value:
        return f"{len(value['prefixItems'])} of {_kind(value['prefixItems'][0])}"
    if value.get("type") == "array":
        return f"list of {_kind(value['items'])}"
    if isinstance(value.get("additionalProperties"), dict):
        return f"table of {_kind(value['additionalProperties'])} by name"
    limits = [f"{sign} {value[key]:g}" for key, sign in _LIMITS.items() if key in value]
    return " ".join([str(value["type"]), *limits])


_LIMITS = {"exclusiveMinimum": ">", "exclusiveMaximum": "<", "minimum": "≥"}


def _default(value: dict[str, Any]) -> str:
    default = value.get("default")
    return "none" if default is None else f"`{default}`"


if __name__ == "__main__":
    sys.stdout.write(markdown())
