"""The product's verbs: one in, one out; lists in, lists out; what is remembered and what is refused."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from fake_embedder import WIDTH, FakeEmbedder
from motions import random_motion, standing, walking

import motionrt
from motionrt.errors import GalleryError, GalleryNotFoundError, InvalidInputError
from motionrt.models.engine import CPU
from motionrt.retrieval import Gallery, motion_features
from motionrt.runtime import Runtime
from motionrt.services import search as search_module


class CountingModel(FakeEmbedder):
    """Counts the texts it embeds."""

    texts = 0

    def embed_text(self, texts: list[str]) -> np.ndarray:
        self.texts += len(texts)
        return super().embed_text(texts)


@pytest.fixture
def model() -> CountingModel:
    return CountingModel()


@pytest.fixture
def runtime(model: CountingModel) -> Runtime:
    made = Runtime()
    made.model = model  # type: ignore[assignment]  # fills the cached property
    return made


@pytest.fixture
def gallery(model: CountingModel) -> Gallery:
    motions = [walking(60), standing(20), random_motion(450)]
    return Gallery.from_motions(motions, ["walk", "stand", "long"], model)


def test_one_text_gives_hits_and_a_list_gives_a_list_of_them(runtime: Runtime, gallery: Gallery) -> None:
    one = runtime.retrieve("walk", 2, gallery)
    assert [hit.rank for hit in one] == [1, 2]
    assert runtime.retrieve(["walk", "sit"], 2, gallery) == [one, runtime.retrieve("sit", 2, gallery)]


def test_hits_are_the_cosines_of_text_and_windows(runtime: Runtime, gallery: Gallery) -> None:
    query = runtime.embed_text("walk")
    hits = runtime.retrieve("walk", 99, gallery, per_clip=False)
    assert sorted(hit.cosine or 0.0 for hit in hits) == pytest.approx(sorted(gallery.embeddings @ query), abs=1e-6)
    assert len(runtime.retrieve("walk", 99, gallery)) == 3


def test_a_gallery_is_opened_by_its_folder_and_again_only_when_replaced(
    runtime: Runtime, gallery: Gallery, model: CountingModel, tmp_path: Path
) -> None:
    gallery.save(tmp_path)
    assert runtime.gallery(tmp_path) is runtime.gallery(str(tmp_path))
    Gallery.from_motions([walking(30)], ["other"], model).save(tmp_path)
    assert [hit.id for hit in runtime.retrieve("walk", gallery=tmp_path)] == ["other"]


def test_a_gallery_by_another_model_is_refused(runtime: Runtime) -> None:
    other = Gallery.from_motions([walking(30)], ["walk"], FakeEmbedder("0" * 64, "another"))
    with pytest.raises(GalleryError, match="made by the model another"):
        runtime.retrieve("walk", 1, other)


def test_a_missing_gallery_says_how_to_build_one(runtime: Runtime, tmp_path: Path) -> None:
    with pytest.raises(GalleryNotFoundError, match="motionrt gallery build"):
        runtime.retrieve("walk", gallery=tmp_path)


def test_without_a_gallery_the_starter_gallery_is_searched(
    runtime: Runtime, gallery: Gallery, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(search_module, "STARTER_GALLERY", tmp_path)
    with pytest.raises(GalleryNotFoundError, match="starter gallery is not installed"):
        runtime.retrieve("walk")
    gallery.save(tmp_path)
    assert len(runtime.retrieve("walk")) == 3


@pytest.mark.parametrize("k", [0, -2, 1.5])
def test_a_bad_k_is_refused(runtime: Runtime, gallery: Gallery, k: int) -> None:
    with pytest.raises(InvalidInputError, match="k must be"):
        runtime.retrieve("walk", k, gallery)


def test_no_text_at_all_is_refused(runtime: Runtime, gallery: Gallery) -> None:
    with pytest.raises(InvalidInputError, match="at least one text"):
        runtime.retrieve([], 3, gallery)


def test_embeddings_are_one_vector_or_a_matrix(runtime: Runtime) -> None:
    assert runtime.embed_text("walk").shape == (WIDTH,)
    assert runtime.embed_text(["walk"]).shape == (1, WIDTH)
    assert runtime.embed_motion(walking(30)).shape == (WIDTH,)
    assert runtime.embed_motion([walking(30), standing(5)]).shape == (2, WIDTH)


def test_a_motion_file_embeds_as_the_motion_in_it(runtime: Runtime, tmp_path: Path) -> None:
    path = walking(30).save(tmp_path / "walk.npz")
    from_file = runtime.embed_motion(path)
    np.testing.assert_allclose(from_file, runtime.embed_motion(motionrt.load_motion(path)), atol=1e-6)
    assert runtime.embed_motion([str(path), path]).shape == (2, WIDTH)


def test_a_long_motion_embeds_as_the_mean_of_its_windows(runtime: Runtime, model: CountingModel) -> None:
    motion = random_motion(300)
    windows = model.embed_motion([motion_features(motion)[:200], motion_features(motion)[100:]])
    mean = windows.mean(axis=0)
    np.testing.assert_allclose(runtime.embed_motion(motion), mean / np.linalg.norm(mean), atol=1e-6)


def test_no_motion_at_all_is_refused(runtime: Runtime) -> None:
    with pytest.raises(InvalidInputError, match="at least one motion"):
        runtime.embed_motion([])


def test_describe_ranks_a_caption_list_that_is_embedded_once(runtime: Runtime, model: CountingModel) -> None:
    captions = ["walk", "sit", "jump"]
    first = runtime.describe(walking(40), 2, captions)
    assert [d.rank for d in first] == [1, 2]
    assert first[0].score >= first[1].score
    assert first == runtime.describe(walking(40), 2, captions)
    assert model.texts == 3


def test_describe_has_captions_of_its_own(runtime: Runtime) -> None:
    found = runtime.describe(walking(40), 3)
    assert len({d.text for d in found}) == 3


def test_captions_that_are_embedded_on_disk_are_not_embedded_again(
    runtime: Runtime, model: CountingModel, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(search_module, "EMBEDDED_CAPTIONS", tmp_path / "captions.npz")
    runtime.captions().save(tmp_path / "captions.npz")
    embedded = model.texts
    again = Runtime()
    again.model = model  # type: ignore[assignment]
    assert again.captions().texts == runtime.captions().texts
    assert model.texts == embedded
    assert again.captions(["walk"]).texts == ("walk",)
    assert model.texts == embedded + 1


def test_moments_rank_spans_of_a_long_motion(runtime: Runtime) -> None:
    found = runtime.moments("walk", random_motion(200), k=4)
    assert 1 <= len(found.best) <= 4
    assert all(0 <= m.start_s < m.end_s <= 10 for m in found.best)
    assert found.curve.shape == (200,)


def test_galleries_are_built_and_updated_through_the_runtime(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[dict[str, object]] = []

    def open_model(models: object, **options: object) -> FakeEmbedder:
        opened.append({"models": models, **options})
        return FakeEmbedder()

    monkeypatch.setattr(search_module, "TextMotionModel", open_model)
    walking(30).save(tmp_path / "walk.bvh")
    runtime = Runtime("my models", threads=2)
    assert runtime.build_gallery(tmp_path).added == ("walk.bvh",)
    standing(30).save(tmp_path / "stand.bvh")
    assert runtime.update_gallery(tmp_path).added == ("stand.bvh",)
    assert (
        opened == [{"models": "my models", "variant": None, "threads": 1, "providers": CPU}] * 2
    )  # one thread each, for the same bytes anywhere


def test_the_package_offers_its_names_lazily() -> None:
    assert motionrt.Runtime is Runtime
    assert motionrt.Gallery is Gallery
    assert motionrt.errors.MotionRTError is motionrt.MotionRTError
    assert set(motionrt.__all__) == set(dir(motionrt))
    assert isinstance(motionrt.__version__, str)
    with pytest.raises(AttributeError, match="no attribute 'Nonsense'"):
        motionrt.Nonsense  # noqa: B018


IMPORTED = """
import sys, motionrt.runtime
names = "torch onnx scipy transformers onnxruntime tokenizers yaml motionrt_training motionrt_export"
print([name for name in names.split() if name in sys.modules])
"""


def test_importing_the_runtime_loads_neither_scipy_nor_a_session_library() -> None:
    done = subprocess.run([sys.executable, "-c", IMPORTED], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
