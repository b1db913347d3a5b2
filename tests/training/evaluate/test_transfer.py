"""Search in sources that were not trained on: what is trained, what is measured, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="training tests need torch (extra 'train')")

from motionrt.motion.features import guo263  # noqa: E402
from motionrt_training.checkpoint import save_atomically  # noqa: E402
from motionrt_training.corpora.pack import pack  # noqa: E402
from motionrt_training.evaluate.ablations import TABLES, folder_of  # noqa: E402
from motionrt_training.evaluate.pairs import read_pairs  # noqa: E402
from motionrt_training.evaluate.transfer import HEAD, main, measured, table_of, transfer_table  # noqa: E402
from motionrt_training.networks.tmr import TMR  # noqa: E402
from motionrt_training.recipes import tmr  # noqa: E402


class Words:
    """Token features of a text: of width 4, the same for every text but for the number in it."""

    def encode(self, text: str) -> object:
        row = np.full((1, 1, 4), float(text.rsplit(maxsplit=1)[-1]), np.float32)
        return type("Encoded", (), {"token_features": row})()


class ByNumber:
    """Finds every motion by the number in its text, the first feature of the motion."""

    def embed_text(self, texts: list[str]) -> np.ndarray:
        return np.eye(8, dtype=np.float32)[[int(text.split()[-1]) for text in texts]]

    def embed_motion(self, features: list[np.ndarray]) -> np.ndarray:
        return np.eye(8, dtype=np.float32)[[int(x[0, 0]) for x in features]]


@pytest.fixture
def corpus(tmp_path: Path) -> Path:
    rows = []
    for number in range(8):
        features = np.full((6, guo263.WIDTH), number, np.float16)
        source, split = "ab"[number % 2], "train" if number < 2 else "test"
        said = {"texts": [f"move {number}"], "texts_mirror": [f"move {number}"]}
        rows.append((features, {"id": f"c{number}", "split": split, "source": source, "windows": [], **said}))
    return pack(rows, tmp_path / "corpus.npz")


def test_the_networks_are_those_of_the_ablations_but_for_what_is_left_out() -> None:
    everything, without = table_of(["cmu"]).rows
    assert folder_of(Path("x"), table_of(["cmu"]), everything) == folder_of(
        Path("x"), TABLES["rivals"], TABLES["rivals"].rows[-1]
    )
    words = ["--corpus", "a.npz", "--out", "x", *without.options.split()]
    assert tmr.parser().parse_args(words).leave_out == "cmu"


def test_only_the_clips_of_the_source_compete(corpus: Path) -> None:
    cells = dict(zip(HEAD[4:], measured(ByNumber(), read_pairs(corpus, "test", "a")), strict=True))
    assert (cells["pairs"], cells["R@1"], cells["MedR"], cells["side"]) == ("3", "100.0", "1.0", "nan")


def test_each_source_is_searched_by_who_saw_it_and_by_who_did_not(corpus: Path, tmp_path: Path) -> None:
    table = table_of(["b"])
    for step, row in enumerate(table.rows):
        net = TMR(text_dim=4, d=8, layers=1, heads=2, ff=8)
        state = {"model": net.state_dict(), "notes": {"network": net.config}, "step": step, "elapsed": 60.0 * step}
        save_atomically(state, folder_of(tmp_path, table, row) / "best.pt")
    lines = transfer_table(["b"], corpus, tmp_path, Words()).splitlines()
    assert lines[2].startswith("| b | all sources | 0 | 0.0 | 3 |")
    assert lines[3].startswith("| b | all but b | 1 | 1.0 | 3 |")


def test_a_source_that_is_not_there_is_refused_before_anything_is_trained(corpus: Path, tmp_path: Path) -> None:
    with pytest.raises(SystemExit, match=r"error: no clip is of the source 'c'; the corpus has a, b"):
        main(["--corpus", str(corpus), "--leave-out", "c", "--out", str(tmp_path)])
