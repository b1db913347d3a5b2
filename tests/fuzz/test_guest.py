"""A guest in other programs: Ctrl-C, threads, signal handlers, long motions, forked and spawned processes."""

from __future__ import annotations

import multiprocessing
from pathlib import Path

import long_motions
import numpy as np
import pytest
from fake_embedder import FakeEmbedder
from interrupts import LIMIT_S, prepare, waits
from motions import walking

from motionrt import Runtime
from motionrt.retrieval import Gallery


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("guest")
    prepare(made)
    return made


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="the time of the processor is read from /proc")
@pytest.mark.parametrize("call", ["walk", "generate", "build_gallery", "load bvh"])
def test_ctrl_c_ends_a_long_call_at_once_and_leaves_nothing_behind(folder: Path, call: str) -> None:
    seconds, wrong = waits(call, folder, moments=(0.15, 0.4))
    assert [words for words in wrong if "over" not in words] == []
    assert max(seconds, default=1.0) <= LIMIT_S


@pytest.mark.skipif(not Path("/proc/self/clear_refs").exists(), reason="the peak of memory is read from /proc")
@pytest.mark.parametrize(
    "name", ["resample to 20 fps", "mirror", "guo263", "retarget_to", "save .bvh", "save .npz", "load .npz"]
)
def test_a_long_motion_takes_memory_in_proportion_to_its_frames(tmp_path: Path, name: str) -> None:
    frames = 40_000
    motion, calls = walking(frames, fps=30.0), long_motions.calls(tmp_path)
    if name.startswith("load"):
        calls[name.replace("load", "save")](motion)
    grown, _, said = long_motions.grown(calls[name], motion)
    assert grown > 0, said
    assert grown <= long_motions.LIMIT * frames + (60 << 20)


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # of fork in a process with threads
@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
def test_a_process_that_was_started_from_here_searches_and_embeds_as_this_one(tmp_path: Path, method: str) -> None:
    gallery = Gallery.from_motions([walking(12), walking(20, speed=2.0)], ["a", "b"], FakeEmbedder())
    gallery.save(tmp_path / "gallery")
    expected = Runtime(threads=1).embed_text("a person walks")
    with multiprocessing.get_context(method).Pool(1) as pool:
        hits, found = pool.apply(_searched, (tmp_path / "gallery", gallery.embeddings[0].copy()))
    assert hits == [hit.id for hit in gallery.search(gallery.embeddings[0], 2)]
    np.testing.assert_array_equal(found, expected)


def _searched(folder: Path, query: np.ndarray) -> tuple[list[str], np.ndarray]:
    """In the other process: a gallery, and a Runtime of its own."""
    return [hit.id for hit in Gallery.open(folder).search(query, 2)], Runtime(threads=1).embed_text("a person walks")
