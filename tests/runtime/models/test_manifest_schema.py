"""The published JSON Schema says what the typed reader says, of shipped manifests and of ones that were changed."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from tiny_models import TINY, TINY_GENERATORS

import motionrt
from motionrt.errors import ManifestError
from motionrt.models import find_manifest
from motionrt.models.reading import manifest_of

jsonschema = pytest.importorskip("jsonschema", reason="jsonschema is not installed; the dev extra brings it")

SCHEMA = json.loads(
    (Path(motionrt.__file__).parent / "_assets" / "models_manifest.schema.json").read_text(encoding="utf-8")
)
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)
NAME = "models_manifest.yaml"
RICH: dict[str, Any] = yaml.safe_load((TINY / NAME).read_text(encoding="utf-8"))
RICH["models"] = {name: RICH["models"][name] for name in ("tmr_text", "tmr_motion")}
RICH["models"]["tmr_text"]["statistics"] = [{"name": "m", "shape": [2, 3], "sha256": "0" * 64, "source": "tmr"}]
RICH["models"]["tmr_text"]["variants"]["tiny"].update(benchmark={"p50_ms": 1.5}, quality={"R1": 59})

PLAIN = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-3, 10**12),
    st.floats(-1e9, 1e9),
    st.sampled_from(
        ["", " ", "a", "A b", "float32", "0" * 64, "0" * 63, "f/x.onnx", "../x", "a/../b", "/x", "c:\\x", "x\n"]
    ),
    st.sampled_from(["a/./b", "..", ".", "a//b", "a/", "...", "a/..b", "F" * 64, "0" * 64 + "\n", "\x1f", "é/ü.onnx"]),
    st.text(max_size=6),
)
VALUE = st.recursive(
    PLAIN,
    lambda inner: st.one_of(st.lists(inner, max_size=2), st.dictionaries(st.text(max_size=4), inner, max_size=2)),
    max_leaves=4,
)


def paths(content: Any, here: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Where every value stands."""
    items = content.items() if isinstance(content, dict) else enumerate(content) if isinstance(content, list) else ()
    return [here, *(path for key, value in items for path in paths(value, (*here, key)))]


PATHS = paths(RICH)[1:]


def at(content: Any, path: tuple[Any, ...]) -> Any:
    for key in path:
        content = content[key]
    return content


def accepted(content: Any) -> bool:
    try:
        manifest_of(content, Path(NAME))
    except ManifestError:
        return False
    return True


def test_the_schema_is_a_schema_and_tells_of_every_field() -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    for name, part in {"": SCHEMA, **SCHEMA["$defs"]}.items():
        assert "description" in part, name
        if "properties" in part:
            assert part["additionalProperties"] is False
            assert [key for key, told in part["properties"].items() if len(told["description"]) < 8] == []


@pytest.mark.parametrize("folder", [TINY, TINY_GENERATORS, None], ids=["tiny", "generators", "shipped"])
def test_manifests_conform(folder: Path | None) -> None:
    path = folder / NAME if folder else find_manifest()
    content = yaml.safe_load(path.read_text(encoding="utf-8"))
    assert [error.message for error in VALIDATOR.iter_errors(content)] == []
    assert accepted(content)


def test_the_rich_manifest_conforms() -> None:
    assert any("tokenizer" in model for model in RICH["models"].values())
    assert VALIDATOR.is_valid(RICH)
    assert accepted(RICH)


@settings(max_examples=400, deadline=None)
@given(st.sampled_from(PATHS), VALUE)
def test_another_value_is_accepted_or_refused_by_both(path: tuple[Any, ...], value: Any) -> None:
    content = copy.deepcopy(RICH)
    at(content, path[:-1])[path[-1]] = value
    assert VALIDATOR.is_valid(content) == accepted(content)


@pytest.mark.parametrize("path", PATHS, ids=lambda path: ".".join(map(str, path)))
def test_a_missing_value_is_accepted_or_refused_by_both(path: tuple[Any, ...]) -> None:
    content = copy.deepcopy(RICH)
    del at(content, path[:-1])[path[-1]]
    assert VALIDATOR.is_valid(content) == accepted(content)


@settings(max_examples=200, deadline=None)
@given(st.sampled_from([path for path in PATHS if isinstance(at(RICH, path), dict)]), st.text(max_size=8), VALUE)
def test_another_key_is_accepted_or_refused_by_both(path: tuple[Any, ...], key: str, value: Any) -> None:
    content = copy.deepcopy(RICH)
    at(content, path)[key] = value
    assert VALIDATOR.is_valid(content) == accepted(content)
