"""What engines can open: one list of operators for each, in the text files of this folder."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import onnx
from onnx import GraphProto, NodeProto

FOLDER = Path(__file__).parent


@dataclass(frozen=True)
class Target:
    """An engine and what it opens.

    Attributes:
        name: as in ``unity``, the name of its list.
        opset: the newest version of the standard operators that it knows.
        operators: names of operators; of any other domain than the standard one none; empty: all standard ones.
        falls_back: whether what is not in the list is computed elsewhere, so that a file opens nevertheless.
    """

    name: str
    opset: int
    operators: frozenset[str]
    falls_back: bool

    def refuses(self, model: onnx.ModelProto) -> list[str]:
        """Why the engine would not open a model; empty where it would."""
        used, versions = operators(model), {one.domain: one.version for one in model.opset_import}
        foreign = sorted({domain for domain, _ in used if domain})
        found = [f"operators of {domain}" for domain in foreign]
        if versions.get("", 0) > self.opset:
            found.append(f"opset {versions['']}, newer than {self.opset}")
        return found if self.falls_back or not self.operators else found + self.outside(model)

    def outside(self, model: onnx.ModelProto) -> list[str]:
        """Standard operators of a model that are not in the list."""
        names = {name for domain, name in operators(model) if not domain}
        return sorted(names - self.operators) if self.operators else []


def targets() -> dict[str, Target]:
    """Every list of the folder by its name."""
    return {path.stem: _read(path) for path in sorted(FOLDER.glob("*.txt"))}


def operators(model: onnx.ModelProto) -> set[tuple[str, str]]:
    """``(domain, name)`` of every operator of a model and of its branches; the standard domain is ``""``."""
    return {("" if node.domain == "ai.onnx" else node.domain, node.op_type) for node in _nodes(model.graph)}


def _nodes(graph: GraphProto) -> Iterator[NodeProto]:
    for node in graph.node:
        yield node
        for attribute in node.attribute:
            for inner in (attribute.g, *attribute.graphs):
                yield from _nodes(inner)


def _read(path: Path) -> Target:
    lines = path.read_text(encoding="ascii").split("\n")
    notes = [line[1:].strip() for line in lines if line.startswith("#")]
    opset = next(int(note.removeprefix("opset:")) for note in notes if note.startswith("opset:"))
    names = frozenset(line.strip() for line in lines if line.strip() and not line.startswith("#"))
    return Target(path.stem, opset, names, "falls back" in notes)
