"""The MCP server as an assistant meets it: through the official client, in memory and over stdin and stdout."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any

import pytest

from motionrt import load_motion
from motionrt.runtime import Runtime

mcp = pytest.importorskip("mcp", reason="the extra mcp is not installed")
import anyio  # noqa: E402 - which mcp brings
from mcp import Client  # noqa: E402

from motionrt.serving import Desk, make_assistant  # noqa: E402


def call(runtime: Runtime, library: Path, folder: Path, *calls: tuple[str, dict[str, Any]]) -> list[Any]:
    async def run() -> list[Any]:
        async with Client(make_assistant(Desk(runtime, {"own": library}), folder)) as client:
            return [await client.call_tool(name, arguments) for name, arguments in calls]

    return anyio.run(run)


def value(result: Any) -> Any:
    assert not result.is_error, result.content
    return json.loads(result.content[0].text)


def test_it_offers_the_verbs_with_words_for_each(runtime: Runtime, library: Path, tmp_path: Path) -> None:
    async def run() -> Any:
        async with Client(make_assistant(Desk(runtime, {"own": library}), tmp_path)) as client:
            return await client.list_tools()

    tools = {tool.name: tool for tool in anyio.run(run).tools}
    verbs = {"galleries", "retrieve", "similar", "save_clip", "describe", "convert", "generate", "compose", "walk"}
    assert set(tools) == verbs
    assert all(tool.description for tool in tools.values())


def test_motion_is_found_made_saved_and_described(runtime: Runtime, library: Path, tmp_path: Path) -> None:
    folder = tmp_path / "files"
    results = call(
        runtime,
        library,
        folder,
        ("retrieve", {"text": "walks", "k": 2}),
        ("save_clip", {"clip": "long.npz", "file": "part.npz", "start_s": 0, "end_s": 2}),
        ("generate", {"text": "walk", "file": "made.glb", "seconds": 1.0, "seed": 1}),
        ("compose", {"texts": ["walk", "wave the right hand"], "file": "both.bvh", "seed": 1}),
        ("walk", {"x": 0, "z": 3, "file": "there.npz"}),
        ("convert", {"file": "part.npz", "to": "part.bvh", "fps": 10}),
        ("describe", {"file": "part.npz", "k": 2}),
    )
    hits, part, made, both, there, converted, described = (value(result) for result in results)
    assert [hit["clip"] for hit in hits["hits"]] == [hit.id for hit in runtime.retrieve("walks", 2, library)]
    assert (part["seconds"], part["fps"]) == (2.0, 20.0)
    for saved in (part, made, both, there, converted):
        assert load_motion(saved["file"]).frames == saved["frames"]
    assert load_motion(there["file"]).root[-1, 2] == pytest.approx(3, abs=0.5)
    assert len(described["captions"]) == 2
    assert described["seconds"] == 2.0


@pytest.mark.parametrize("name", ["../out.npz", "/tmp/out.npz", ".hidden.npz", "a/b.npz", "out.exe", ""])
def test_files_stay_in_the_folder(runtime: Runtime, library: Path, tmp_path: Path, name: str) -> None:
    folder = tmp_path / "files"
    folder.mkdir()
    results = call(runtime, library, folder, ("generate", {"text": "walk", "file": name, "seconds": 1.0}),
                   ("describe", {"file": name}))  # fmt: skip
    assert all(result.is_error for result in results)
    assert "name" in results[0].content[0].text
    assert list(tmp_path.rglob("*.npz")) == []


SERVER = """
import sys
sys.path[:0] = {paths!r}
from pathlib import Path
from fake_character_models import FakeCharacterModels
from fake_embedder import FakeEmbedder
from tiny_models import TINY_GENERATORS
from motionrt.runtime import Runtime
from motionrt.serving import Desk, make_assistant
runtime = Runtime(TINY_GENERATORS, variant="tiny")
vars(runtime).update(model=FakeEmbedder(), character_models=FakeCharacterModels())
make_assistant(Desk(runtime, {{"own": Path({library!r})}}), Path({folder!r})).run()
"""


def test_a_process_of_its_own_serves_over_stdin_and_stdout(library: Path, tmp_path: Path) -> None:
    from mcp import StdioServerParameters, stdio_client

    code = SERVER.format(paths=sys.path, library=str(library), folder=str(tmp_path))
    server = StdioServerParameters(command=sys.executable, args=["-c", code], env=dict(os.environ))

    async def run() -> Any:
        with anyio.fail_after(60):
            async with Client(stdio_client(server)) as client:
                return await client.call_tool("retrieve", {"text": "walks", "k": 1})

    assert len(value(anyio.run(run))["hits"]) == 1
