"""One command: every file, proven, and a manifest that the runtime reads; the same bytes when run again."""

from __future__ import annotations

import hashlib
import shutil
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from tiny_nets import TinySources, tiny_sources  # noqa: E402

from motionrt.errors import ChecksumError  # noqa: E402
from motionrt.models import TextMotionModel, load_manifest, verify  # noqa: E402
from motionrt.motion.features import sinc135  # noqa: E402
from motionrt.synthesis.generating import Generator  # noqa: E402
from motionrt.synthesis.sampling import Sampling  # noqa: E402
from motionrt.synthesis.smoothing import smoothed  # noqa: E402
from motionrt_export.__main__ import main  # noqa: E402
from motionrt_export.measures import Figures  # noqa: E402
from motionrt_export.publish import Layout, publish, tolerance  # noqa: E402
from motionrt_export.sources import MissingCheckpointsError  # noqa: E402
from motionrt_export.validate import Subject, ValidationError, validate  # noqa: E402
from motionrt_training.networks.latent_denoiser import draw_latents  # noqa: E402


def layout(root: Path) -> Layout:
    return Layout(root / "models_manifest.yaml", root / "models", root / "build" / "models")


def publish_tiny(root: Path) -> TinySources:
    sources = tiny_sources(root / "models")

    def check(model: str, variant: str, file: Path) -> Figures:
        source, limits = sources.source(model), tolerance(model, variant)
        content, rest = file.read_bytes(), {"lengths": (1, 9), "batches": (1, 2), "trial": source.trial}
        subject = Subject(source.spec, content, source.reference, source.examples, limits, source.scale, **rest)
        return validate(subject)

    publish(sources, layout(root), check, {"tmr_text": {"R1": 50.0}}, lambda _: None)
    return sources


@pytest.fixture(scope="module")
def published(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, TinySources]:
    root = tmp_path_factory.mktemp("published")
    return root, publish_tiny(root)


def digests(root: Path) -> dict[str, str]:
    files = sorted(path for path in root.rglob("*") if path.is_file())
    return {path.relative_to(root).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def test_a_second_run_writes_the_same_bytes(published: tuple[Path, TinySources], tmp_path: Path) -> None:
    publish_tiny(tmp_path)
    assert digests(tmp_path) == digests(published[0])
    assert len(digests(tmp_path)) == 11 + 10 + 2 + 6  # shipped files, others; manifest, tokenizer; checkpoints


def test_the_runtime_reads_the_manifest_and_finds_every_file(published: tuple[Path, TinySources]) -> None:
    manifest = load_manifest(published[0] / "models_manifest.yaml")
    assert {report.state for report in verify(manifest)} == {"ok"}
    text = manifest.model("tmr_text")
    assert text.default_variant == "int8"
    assert text.quality == {"R1": 50.0}
    assert manifest.model("tmr_motion").quality == {"test_R1": 12.35}
    assert text.recipe["steps"] == 10
    assert text.variant("int8").shipped
    assert not text.variant("fp32").shipped
    assert text.variant("fp32").parity["embedding"]["max_abs_error"] <= 1e-4
    assert "project: 8-bit blocks" in text.variant("int8").quantisation


@pytest.mark.parametrize(("variant", "least"), [("fp32", 0.99999), ("int8", 0.99)])
def test_the_runtime_gives_the_embeddings_of_torch(
    published: tuple[Path, TinySources], variant: str, least: float
) -> None:
    root, sources = published
    model = TextMotionModel(root, variant=variant, threads=1)
    network = sources.tmr.model
    ids = torch.from_numpy(model.sentences.tokens("a person walks in a circle"))[None]
    features = sources.backbone(ids, torch.ones_like(ids))
    text = torch.nn.functional.normalize(network.encode_text(features, torch.ones_like(ids)).mu, dim=-1)
    clip = torch.randn(1, 50, 263) * network.motion_std + network.motion_mean
    motion = torch.nn.functional.normalize(network.encode_motion(clip, torch.ones(1, 50)).mu, dim=-1)
    assert float(model.embed_text(["a person walks in a circle"])[0] @ text[0].numpy()) > least
    assert float(model.embed_motion([clip[0].numpy()])[0] @ motion[0].numpy()) > least


def test_the_runtime_decodes_what_torch_decodes(published: tuple[Path, TinySources]) -> None:
    root, sources = published
    network, latent = sources.tmr.model, torch.randn(2, 256)
    expected = network.decode(latent, torch.ones(2, 30)).numpy()
    found = TextMotionModel(root, variant="fp32").decode(latent.numpy(), 30)
    np.testing.assert_allclose(found, expected, atol=1e-4)


def test_a_file_beyond_its_tolerance_leaves_no_manifest(tmp_path: Path) -> None:
    def check(model: str, variant: str, file: Path) -> Figures:
        raise ValidationError(f"{model}.{variant}: beyond")

    with pytest.raises(ValidationError, match=r"sentence_encoder\.fp32: beyond"):
        publish(tiny_sources(tmp_path / "models"), layout(tmp_path), check, {}, lambda _: None)
    assert not (tmp_path / "models_manifest.yaml").exists()


def test_without_all_checkpoints_nothing_is_written(tmp_path: Path) -> None:
    sources = tiny_sources(tmp_path / "models")
    for name in ("temos", "latent_denoiser"):
        (tmp_path / "models" / f"{name}.safetensors").unlink()
    before = digests(tmp_path)
    with pytest.raises(MissingCheckpointsError, match=r"no released model at .*temos.safetensors, .*latent_denoiser"):
        publish(sources, layout(tmp_path), lambda *_: {}, {}, lambda _: None)
    assert digests(tmp_path) == before


def test_all_without_a_checkpoint_says_which(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folders = {"--out": "models", "--build": "build", "--manifest": "models_manifest.yaml"}
    options = [part for option, name in folders.items() for part in (option, str(tmp_path / name))]
    assert main(["all", "--checkpoints", str(tmp_path), *options]) == 1
    assert "latent_denoiser.safetensors" in capsys.readouterr().err
    assert digests(tmp_path) == {}


def test_the_runtime_generates_what_torch_generates(published: tuple[Path, TinySources]) -> None:
    root, sources = published
    temos, denoiser, model = sources.temos.model, sources.latent_denoiser.model, TextMotionModel(root, threads=1)
    generator = Generator(model.sessions, "fp32")
    ids = torch.from_numpy(generator.sentences.tokens("wave the right hand"))[None]
    features, mask = sources.backbone(ids, torch.ones_like(ids)), torch.ones_like(ids)
    how = Sampling(seconds=1.1, seed=3, sampler="diffusion", steps=4)
    noise = torch.from_numpy(how.noise(0, 256))[None]
    told = temos.encode_text(features, mask).mu[:, None]
    latent = draw_latents(denoiser, told, torch.ones(1, 1), noise, steps=4, guidance=how.guidance)
    expected = temos.decode(latent, torch.ones(1, 33, dtype=torch.bool)).numpy()[0]
    found = generator.decode(generator.latents("wave the right hand", how), how.frames)[0]
    wanted = sinc135.decode(smoothed(expected)).positions()
    np.testing.assert_allclose(found.positions(), wanted, atol=1e-3)


def test_a_published_file_that_is_exchanged_is_refused(published: tuple[Path, TinySources], tmp_path: Path) -> None:
    shutil.copytree(published[0], tmp_path, dirs_exist_ok=True)
    text = tmp_path / "models" / "tmr_text.int8.onnx"
    text.write_bytes((tmp_path / "models" / "tmr_motion.int8.onnx").read_bytes())
    with pytest.raises(ChecksumError, match=r"expected [0-9a-f]{64}, found [0-9a-f]{64}"):
        TextMotionModel(tmp_path).embed_text(["walk"])


def test_the_command_without_a_checkpoint_says_what_is_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["validate", "--model", "tmr_text", "--variant", "int8", "--file", str(tmp_path / "x.onnx")]
    assert main([*arguments, "--checkpoints", str(tmp_path)]) == 1
    assert "error: no released model at" in capsys.readouterr().err
