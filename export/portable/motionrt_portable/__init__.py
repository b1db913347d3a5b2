"""The models of motionrt as ONNX files that engines open: standard operators of opset 15, weights stored as float16.

>>> from motionrt_portable import FOLDER, model
>>> model("walknet")  # doctest: +SKIP
PosixPath('.../models/walknet.portable.onnx')
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent / "models"
"""Where the files are, with ``index.json`` that describes them."""


def index() -> dict[str, Any]:
    """What is known of every model: file, sha256, inputs and outputs with shapes and units, operators, errors."""
    found: dict[str, Any] = json.loads((FOLDER / "index.json").read_text(encoding="utf-8"))["models"]
    return found


def model(name: str) -> Path:
    """The file of a model; ValueError that lists the models where there is none of that name."""
    if name not in (known := index()):
        raise ValueError(f"no model {name!r}; choose one of: {', '.join(known)}")
    return FOLDER / str(known[name]["file"])
