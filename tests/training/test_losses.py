"""The losses against torch.distributions and hand-worked numbers."""

from __future__ import annotations

import math

import pytest

torch = pytest.importorskip("torch", reason="training tests need torch (extra 'train')")

from torch.distributions import Normal, kl_divergence  # noqa: E402

from motionrt_training import losses as L  # noqa: E402
from motionrt_training.networks.actor import Distribution  # noqa: E402


def drawn(seed: int) -> Distribution:
    generator = torch.Generator().manual_seed(seed)
    return Distribution(torch.randn(4, 6, generator=generator), torch.randn(4, 6, generator=generator))


def normal(q: Distribution) -> Normal:
    return Normal(q.mu, (0.5 * q.logvar).exp())


def test_kl_is_that_of_torch_distributions() -> None:
    q, p, standard = drawn(0), drawn(1), Normal(0.0, 1.0)
    torch.testing.assert_close(L.kl_to_standard(q), kl_divergence(normal(q), standard).mean())
    torch.testing.assert_close(L.kl_between(q, p), kl_divergence(normal(q), normal(p)).mean())
    terms = [(q, p), (p, q)]
    expected = sum(kl_divergence(normal(a), normal(b)).mean() for a, b in terms)
    expected = expected + sum(kl_divergence(normal(a), standard).mean() for a in (q, p))
    torch.testing.assert_close(L.kl_terms(q, p), expected)


def test_info_nce_of_two_orthogonal_pairs() -> None:
    # cosines: own 1, other 0; temperature 0.1 -> -log(e^10 / (e^10 + 1))
    eye = torch.eye(2) * 7.0
    assert float(L.info_nce(eye, eye)) == pytest.approx(math.log1p(math.exp(-10.0)), rel=1e-3)


def test_info_nce_averages_its_two_directions() -> None:
    text, motion = torch.tensor([[1.0, 0.0], [0.0, 1.0]]), torch.tensor([[1.0, 0.0], [1.0, 0.0]])
    # cosines [[1, 1], [0, 0]] at temperature 1: rows log 2 each; columns log(1 + e^-1) and log(1 + e)
    rows, columns = math.log(2.0), (math.log1p(math.exp(-1.0)) + math.log1p(math.e)) / 2
    assert float(L.info_nce(text, motion, temperature=1.0)) == pytest.approx((rows + columns) / 2, rel=1e-5)


def test_info_nce_leaves_dropped_negatives_out_of_the_denominator() -> None:
    generator = torch.Generator().manual_seed(0)
    text, motion = torch.randn(3, 5, generator=generator), torch.randn(3, 5, generator=generator)
    keep = torch.tensor([[True, False, True], [False, True, True], [True, True, True]])
    cosine = torch.nn.functional.normalize(text, dim=1) @ torch.nn.functional.normalize(motion, dim=1).T
    expected = 0.0
    for matrix, kept in ((cosine, keep), (cosine.T, keep.T)):
        for i in range(3):
            denominator = sum(math.exp(float(matrix[i, j]) / 0.1) for j in range(3) if kept[i, j])
            expected += (math.log(denominator) - float(matrix[i, i]) / 0.1) / 6
    assert float(L.info_nce(text, motion, keep)) == pytest.approx(expected, rel=1e-4)
    nothing = torch.zeros(3, 3, dtype=torch.bool)
    assert float(L.info_nce(text, motion, nothing)) == pytest.approx(0.0, abs=1e-6)


def test_margin_loss_by_hand() -> None:
    text, motion = torch.tensor([[0.0], [1.0]]), torch.tensor([[0.5], [3.0]])
    # own: 0.25 and 4, mean 2.125; others: distances 3 and 0.5 -> pushes 0 and 0.25, mean 0.125
    own = torch.eye(len(text), dtype=torch.bool)
    assert float(L.margin_loss(text, motion, own, ~own)) == pytest.approx(2.25, rel=1e-4)


def test_reconstruction_ignores_what_the_mask_hides() -> None:
    target = torch.zeros(2, 3, 2)
    predicted = torch.tensor([[[0.5, 0.5], [2.0, 2.0], [9.0, 9.0]], [[1.0, 0.0], [9.0, 9.0], [9.0, 9.0]]])
    mask = torch.tensor([[True, True, False], [True, False, False]])
    # smooth L1: 0.5 -> 0.125, 2 -> 1.5, 1 -> 0.5, 0 -> 0
    assert L.reconstruction(predicted, target, mask).tolist() == pytest.approx([0.8125, 0.25])


def test_latent_distance_is_smooth_l1() -> None:
    assert float(L.latent_distance(torch.tensor([[0.0, 0.0]]), torch.tensor([[0.5, 3.0]]))) == pytest.approx(1.3125)


def test_paired_nce_of_one_motion_a_text_is_info_nce() -> None:
    generator = torch.Generator().manual_seed(3)
    text, motion = torch.randn(5, 8, generator=generator), torch.randn(5, 8, generator=generator)
    own = torch.eye(5, dtype=torch.bool)
    keep = torch.rand(5, 5, generator=generator) > 0.3
    found = L.paired_nce(text, motion, own, keep.float(), 0.2)
    torch.testing.assert_close(found, L.info_nce(text, motion, keep, 0.2))


def test_paired_nce_by_hand_where_a_text_has_two_motions_and_a_negative_counts_three_times() -> None:
    text = torch.tensor([[1.0, 0.0]])
    motion = torch.tensor([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])
    positive = torch.tensor([[True, True, False]])
    negative = torch.tensor([[0.0, 0.0, 3.0]])
    e = math.exp
    by_text = [-math.log(e(1) / (e(1) + 3 * e(-1))), -math.log(1 / (1 + 3 * e(-1)))]  # by motion nothing is against
    expected = 0.5 * sum(by_text) / 2
    assert float(L.paired_nce(text, motion, positive, negative, 1.0)) == pytest.approx(expected, rel=1e-5)


def test_slot_loss_is_the_mean_cross_entropy_of_known_slots() -> None:
    logits = torch.tensor([[2.0, 0.0, 1.0, 1.0, 1.0], [0.0, 1.0, 3.0, 0.0, 0.0]])
    slots = torch.tensor([[1, 0], [0, 1]])  # the first knows its first slot (of 2), the second its second (of 3)
    e = math.exp
    expected = (-math.log(e(2) / (e(2) + 1)) - math.log(e(3) / (e(3) + 2))) / 2
    assert float(L.slot_loss(logits, slots, [2, 3])) == pytest.approx(expected, rel=1e-5)
