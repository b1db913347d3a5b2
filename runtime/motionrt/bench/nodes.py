"""onnxruntime's profile of a benchmark: which operators of which models take the time, multiply and read how much."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

_FLOAT = frozenset({"MatMul", "FusedMatMul", "Gemm"})
_INTEGER = frozenset({"DynamicQuantizeMatMul", "MatMulIntegerToFloat", "MatMulInteger", "MatMulNBits"})
_LOOKUPS = frozenset({"Gather", "GatherBlockQuantized", "GatherND"})  # they read the rows that they give, not the table

Shape = Sequence[int]


@dataclass
class Work:
    """What operators did.

    Attributes:
        seconds: by operator.
        runs: how often the model was called.
        macs_fp32: multiply-adds in float32.
        macs_int8: those of 8-bit weights.
        weight_bytes: constants that were read, once for every call of an operator.
        run_seconds: of the model's calls as a whole.
    """

    seconds: dict[str, float] = field(default_factory=dict)
    runs: float = 0.0
    macs_fp32: float = 0.0
    macs_int8: float = 0.0
    weight_bytes: float = 0.0
    run_seconds: float = 0.0

    def __add__(self, other: Work) -> Work:
        both = {**self.seconds, **other.seconds}
        return Work(
            {name: self.seconds.get(name, 0.0) + other.seconds.get(name, 0.0) for name in both},
            self.runs + other.runs,
            self.macs_fp32 + other.macs_fp32,
            self.macs_int8 + other.macs_int8,
            self.weight_bytes + other.weight_bytes,
            self.run_seconds + other.run_seconds,
        )

    def of_one(self, calls: int) -> Work:
        """The share of one call of the benchmark."""
        return Work(
            {name: seconds / calls for name, seconds in self.seconds.items()},
            self.runs / calls,
            self.macs_fp32 / calls,
            self.macs_int8 / calls,
            self.weight_bytes / calls,
            self.run_seconds / calls,
        )


def read_work(profile: Path) -> Work:
    """The work in a profile that onnxruntime wrote."""
    return work_of(json.loads(profile.read_text(encoding="utf-8")))


def work_of(events: Iterable[Mapping[str, Any]]) -> Work:
    """The work in the events of a profile."""
    work = Work()
    for event in events:
        if event.get("name") == "model_run":
            work.run_seconds += event["dur"] / 1e6
            work.runs += 1
        arguments = event.get("args", {})
        if event.get("cat") == "Node" and "op_name" in arguments and "output_type_shape" in arguments:
            _add(work, event["dur"] / 1e6, arguments)
    return work


def _add(work: Work, seconds: float, node: Mapping[str, Any]) -> None:
    operator = node["op_name"]
    work.seconds[operator] = work.seconds.get(operator, 0.0) + seconds
    given, made = _shapes(node["input_type_shape"]), _shapes(node["output_type_shape"])
    integer, multiplies = operator in _INTEGER, operator in _INTEGER | _FLOAT
    depth = given[0][-1] if multiplies and given and given[0] else 0
    macs = float(depth * math.prod(made[0])) if depth else 0.0
    work.macs_int8 += macs if integer else 0.0
    work.macs_fp32 += 0.0 if integer else macs
    work.weight_bytes += _constants(node, given, made, depth, integer)


def _constants(node: Mapping[str, Any], given: list[Shape], made: list[Shape], depth: int, integer: bool) -> float:
    """Bytes of constants; the matrix of a product is not in the profile where it was packed when the model opened."""
    if node["op_name"] in _LOOKUPS:
        return float(node.get("output_size", 0))
    listed = float(node.get("parameter_size", 0))
    packed = depth and not any(len(shape) > 1 for shape in given[1:])
    return listed + (depth * made[0][-1] * (1 if integer else 4) if packed else 0)


def _shapes(listed: Iterable[Mapping[str, Shape]]) -> list[Shape]:
    return [shape for each in listed for shape in each.values()]
