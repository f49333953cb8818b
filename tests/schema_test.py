"""Validates every scene against the JSON Schema that it names, with a validator that knows nothing of minamo.

  schema_test.py FOLDER    FOLDER: of the sources
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any, Iterator

from jsonschema import Draft202012Validator

# Their keys are names that the user chooses.
FREE_NAMES = {"constants", "ode", "fluids"}


def objects(value: Any, under: str = "") -> Iterator[dict[str, Any]]:
    """All objects whose keys are given, those in lists too."""
    if isinstance(value, list):
        for element in value:
            yield from objects(element)
    elif isinstance(value, dict):
        if under not in FREE_NAMES:
            yield value
        for key, below in value.items():
            yield from objects(below, key)


def misspelt(scene: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """The scene with one key misspelt, for every key."""
    for place in range(len(list(objects(scene)))):
        for key in list(objects(scene))[place]:
            copy = json.loads(json.dumps(scene))
            changed = list(objects(copy))[place]
            changed[key + "e"] = changed.pop(key)
            yield key, copy


def problems(path: Path) -> Iterator[str]:
    scene = json.loads(path.read_text())
    schema = json.loads((path.parent / scene["$schema"]).read_text())
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    for error in validator.iter_errors(scene):
        yield f"{path}: {error.json_path}: {error.message}"
    for key, wrong in misspelt(scene):
        if validator.is_valid(wrong):
            yield f"{path}: the schema takes \"{key}e\" for \"{key}\""


def disagreements(scene: dict[str, Any], schema: dict[str, Any]) -> Iterator[str]:
    """Where the schema takes the options of another scheme than the one that a scene without a scheme has."""
    validator = Draft202012Validator(schema)
    for transfer, valid in (({}, True), ({"spin": "gradient"}, True), ({"share": 0.5}, False),
                            ({"scheme": "tpic2", "share": 0.5}, True), ({"scheme": "tpic2", "spin": "gradient"}, False)):
        if validator.is_valid(scene | {"transfer": transfer}) != valid:
            yield f"transfer {transfer}: the program {'takes' if valid else 'refuses'} it, the schema does not"


def main() -> int:
    root = Path(sys.argv[1])
    schema = json.loads((root / "scenes/schema/scene.schema.json").read_text())
    scenes = sorted([*root.glob("scenes/*.json"), *root.glob("tools/example_system/scene.json")])
    found = [problem for path in scenes for problem in problems(path)]
    found += disagreements(json.loads((root / "scenes/dam_break.json").read_text()), schema)
    print("\n".join(found) or f"{len(scenes)} scenes are valid, and not one with a misspelt key")
    return 1 if found or not scenes else 0


if __name__ == "__main__":
    sys.exit(main())
