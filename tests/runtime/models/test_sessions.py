"""Sessions open lazily, once, with quiet options or the caller's own; new lengths cost no memory."""

from __future__ import annotations

import hashlib
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import onnxruntime
import pytest
from tiny_models import TINY, edited

from motionrt.models import Sessions, TextMotionModel, sessions

HEAVY = ("onnxruntime", "tokenizers", "scipy", "torch", "onnx")


def test_importing_and_constructing_loads_nothing_heavy() -> None:
    code = (
        "import sys; from motionrt.models import TextMotionModel; "
        f"TextMotionModel({str(TINY)!r}).fingerprint; "
        f"print([name for name in {HEAVY!r} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_embedding_text_needs_no_scipy() -> None:
    code = (
        "import sys; from motionrt.models import TextMotionModel; "
        f"TextMotionModel({str(TINY)!r}).embed_text(['walk']); "
        "print('scipy' in sys.modules, 'torch' in sys.modules, 'onnx' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False False False"


def test_a_session_is_opened_once_however_many_threads_ask(monkeypatch: pytest.MonkeyPatch) -> None:
    opened = []
    real = onnxruntime.InferenceSession
    monkeypatch.setattr(onnxruntime, "InferenceSession", lambda *a, **k: opened.append(1) or real(*a, **k))
    models, start = Sessions(TINY), threading.Barrier(8)

    def ask(_: int) -> int:
        start.wait()
        return id(models.session("tmr_text"))

    with ThreadPoolExecutor(8) as pool:
        assert len(set(pool.map(ask, range(8)))) == 1
    assert len(opened) == 1


def test_many_threads_get_the_answers_of_one() -> None:
    texts = [f"walk {word} forward {n}" for n in range(10) for word in ("slowly", "quickly")]
    model = TextMotionModel(TINY)
    alone = model.embed_text(texts)
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda text: model.embed_text([text])[0], texts))
    np.testing.assert_array_equal(np.stack(together), alone)


def test_what_is_no_model_is_refused_by_its_reader_when_the_manifest_means_it(tmp_path: Path) -> None:
    rubbish = b"no model"
    entry = {"sha256": hashlib.sha256(rubbish).hexdigest(), "bytes": len(rubbish)}
    manifest = edited(tmp_path, lambda c: c["models"]["tmr_text"]["variants"]["tiny"].update(entry))
    (manifest.parent / "models" / "tmr_text.tiny.onnx").write_bytes(rubbish)
    with pytest.raises(Exception, match="INVALID_PROTOBUF"):
        Sessions(manifest).session("tmr_text")


def test_embedding_text_waits_for_no_gallery_and_no_file_format() -> None:
    code = (
        f"import sys; from motionrt import Runtime; Runtime({str(TINY)!r}).embed_text('walk'); "
        "print([n for n in ('motionrt.retrieval', 'motionrt.formats') if n in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_default_options_are_quiet() -> None:
    options = sessions.quiet_options(2)
    assert options.intra_op_num_threads == 2
    assert options.inter_op_num_threads == 1
    assert options.get_session_config_entry("session.intra_op.allow_spinning") == "0"
    assert options.get_session_config_entry("session.inter_op.allow_spinning") == "0"


def test_the_number_of_threads_reaches_the_session() -> None:
    assert Sessions(TINY, threads=1).session("tmr_text").get_session_options().intra_op_num_threads == 1


def test_own_session_options_are_taken() -> None:
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads, options.logid = 3, "mine"
    session = Sessions(TINY, session_options=options).session("tmr_text")
    assert session.get_session_options().logid == "mine"
    assert session.get_session_options().intra_op_num_threads == 3


def resident_bytes() -> int:
    pages = Path("/proc/self/statm").read_text(encoding="ascii").split()[1]
    return int(pages) * 4096


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="resident memory is read from /proc (Linux)")
def test_a_thousand_calls_of_every_length_do_not_grow_memory() -> None:
    model = TextMotionModel(TINY, threads=1)
    rng = np.random.default_rng(0)
    motion = rng.normal(size=(400, 263)).astype(np.float32)

    def calls(count: int) -> None:
        for n in range(count):
            model.embed_text(["walk forward " * (1 + n % 60)])
            model.embed_motion([motion[: 1 + (37 * n) % 400]])

    calls(400)  # every length once
    before = resident_bytes()
    calls(1000)
    assert resident_bytes() - before < 8_000_000
