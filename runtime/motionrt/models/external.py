"""Whether an ONNX file keeps weights outside of itself  [onnx.proto: TensorProto.external_data, data_location].

onnxruntime reads such files from wherever the model says, and what it does for models that are given as bytes differs
between its versions. No file of motionrt needs any: so they are refused before any session is opened.
"""

from __future__ import annotations

from motionrt.models.protobuf import fields

_EXTERNAL_DATA, _DATA_LOCATION = 13, 14  # of a TensorProto
_DEPTH = 100

# message -> field -> message below it
_BELOW: dict[str, dict[int, str]] = {
    "model": {7: "graph", 20: "training", 25: "function"},
    "training": {1: "graph", 2: "graph"},
    "graph": {1: "node", 5: "tensor", 15: "sparse"},
    "function": {7: "node"},
    "node": {5: "attribute"},
    "attribute": {5: "tensor", 6: "graph", 10: "tensor", 11: "graph", 22: "sparse", 23: "sparse"},
    "sparse": {1: "tensor", 2: "tensor"},
}


def names_other_files(content: bytes) -> bool:
    """Whether any tensor of a model lies in another file; also for content that cannot be told.

    The word ``location`` must stand in such a model, so all the others are known at once.
    """
    if b"location" not in content:
        return False
    try:
        return _search(memoryview(content), "model", 0)
    except (IndexError, ValueError):
        return True


def _search(content: memoryview, kind: str, depth: int) -> bool:
    if depth > _DEPTH:
        raise ValueError("graphs within graphs")
    for field, value, _ in fields(content):
        if kind == "tensor":
            if field == _EXTERNAL_DATA or (field == _DATA_LOCATION and value != 0):
                return True
            continue
        below = _BELOW[kind].get(field)
        if below is not None and not isinstance(value, int) and _search(value, below, depth + 1):
            return True
    return False
