"""The student of the text tower on tiny lessons: word vectors, padding, learning, examinations."""

from __future__ import annotations

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="training tests need torch (extra 'train')")

from motionrt_training.networks.minilm import MiniLM  # noqa: E402
from motionrt_training.networks.student import TextStudent  # noqa: E402
from motionrt_training.student_task import Examination, Lesson, StudentSettings, StudentTask, embed  # noqa: E402

SMALL = StudentSettings(words=32, d=32, layers=1, heads=2, ff=32, dropout=0.0, batch=16)
WORDS = 40


def backbone() -> MiniLM:
    torch.manual_seed(0)
    return MiniLM(vocabulary=WORDS, positions=8, layers=1).requires_grad_(False)


def lesson(count: int, seed: int) -> Lesson:
    """Sentences of two to five words whose embedding is the mean of random vectors of the words."""
    rng, table = np.random.default_rng(seed), np.random.default_rng(7).standard_normal((WORDS, 12))
    ids = [rng.integers(WORDS, size=rng.integers(2, 6)) for _ in range(count)]
    target = np.stack([table[row].mean(0) for row in ids])
    return Lesson(ids, (target / np.linalg.norm(target, axis=1, keepdims=True)).astype(np.float16))


def task() -> StudentTask:
    exam = lesson(10, 3)
    motions = exam.target.astype(np.float32)
    exams = {"val": Examination([exam], motions), "test": Examination([exam], motions)}
    return StudentTask(lesson(60, 1), lesson(200, 2), motions, exams, backbone(), SMALL, seed=1)


def test_word_vectors_keep_what_the_strongest_directions_of_the_sentence_encoder_say() -> None:
    source = backbone()
    student = TextStudent(WORDS, words=39, d=16, layers=1, heads=2, ff=16)
    student.take_words(source)
    table = source.words.weight.numpy().astype(np.float64)
    centred = table - table.mean(0)
    expected, found = (np.corrcoef(x @ x.T, rowvar=False) for x in (centred, student.words.weight.numpy()))
    np.testing.assert_allclose(found, expected, atol=1e-3)  # 39 directions hold all that 40 words can differ by
    assert not student.words.weight.requires_grad


def test_the_embedding_of_a_sentence_does_not_depend_on_longer_ones_beside_it() -> None:
    model = task().model.eval()
    short, long = np.array([3, 4]), np.array([5, 6, 7, 8, 9])
    together = embed(model, [short, long])
    np.testing.assert_allclose(together[:1], embed(model, [short]), atol=1e-6)


def test_the_student_comes_to_say_what_the_teacher_says() -> None:
    work = task()
    optimiser = torch.optim.AdamW([p for p in work.model.parameters() if p.requires_grad], lr=1e-2)
    first = work.validate(work.model.eval())
    for step in range(120):
        loss = work.losses(work.model.train(), work.batch(step))["loss"]
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    last = work.validate(work.model.eval())
    assert last["val_teacher_R1"] == 100.0
    assert last["val_cosine"] > 0.7 > first["val_cosine"]
    assert last["score"] > first["score"]
