"""The networks: shapes, padding, patches, and the ragged training path against the plain one."""

from __future__ import annotations

import pytest

torch = pytest.importorskip("torch", reason="training tests need torch (extra 'train')")

from motionrt_training.networks.actor import ActorDecoder, ActorEncoder, patched  # noqa: E402
from motionrt_training.networks.gru import GruEncoder, last_valid  # noqa: E402
from motionrt_training.networks.tmr import TMR  # noqa: E402
from motionrt_training.networks.transformer import (  # noqa: E402
    Dropout,
    EncoderLayer,
    LatentAttention,
    MultiHeadSelfAttention,
    key_bias,
    set_fused_attention,
    sinusoidal_positions,
)

SMALL = {"d": 16, "layers": 2, "heads": 2, "ff": 32}


def mask_of(*lengths: int) -> torch.Tensor:
    return torch.arange(max(lengths))[None] < torch.tensor(lengths)[:, None]


def ours_as_torch(layer: EncoderLayer) -> torch.nn.TransformerEncoderLayer:
    theirs = torch.nn.TransformerEncoderLayer(16, 2, 32, 0.0, activation="gelu", batch_first=True).eval()
    pairs = {
        "self_attn.in_proj_weight": layer.attention.qkv.weight,
        "self_attn.in_proj_bias": layer.attention.qkv.bias,
        "self_attn.out_proj.weight": layer.attention.out.weight,
        "self_attn.out_proj.bias": layer.attention.out.bias,
        "linear1.weight": layer.feed.up.weight,
        "linear1.bias": layer.feed.up.bias,
        "linear2.weight": layer.feed.down.weight,
        "linear2.bias": layer.feed.down.bias,
        "norm1.weight": layer.norm1.weight,
        "norm1.bias": layer.norm1.bias,
        "norm2.weight": layer.norm2.weight,
        "norm2.bias": layer.norm2.bias,
    }
    theirs.load_state_dict(pairs)
    return theirs


@pytest.mark.parametrize("fused", [False, True])
def test_the_encoder_layer_is_torchs_post_norm_layer(fused: bool) -> None:
    torch.manual_seed(0)
    layer, mask, x = EncoderLayer(16, 2, 32).eval(), mask_of(5, 3), torch.randn(2, 5, 16)
    set_fused_attention(layer, fused)
    expected = ours_as_torch(layer)(x, src_key_padding_mask=~mask)
    torch.testing.assert_close(layer(x, key_bias(mask))[mask], expected[mask], atol=1e-5, rtol=1e-5)


def test_attention_to_one_latent_is_torchs_cross_attention_to_one_key() -> None:
    torch.manual_seed(0)
    theirs, ours = torch.nn.MultiheadAttention(16, 2, batch_first=True), LatentAttention(16)
    ours.value.weight.data, ours.value.bias.data = theirs.in_proj_weight[32:], theirs.in_proj_bias[32:]
    ours.out.load_state_dict(theirs.out_proj.state_dict())
    latent, queries = torch.randn(3, 16), torch.randn(3, 7, 16)
    expected = theirs(queries, latent[:, None], latent[:, None])[0]
    torch.testing.assert_close(ours(latent).expand(-1, 7, -1), expected)


def test_positions_are_sines_and_cosines() -> None:
    positions = sinusoidal_positions(4, 6, torch.zeros(()))
    assert positions[3, 0] == pytest.approx(0.14112, abs=1e-5)  # sin 3
    assert positions[3, 3] == pytest.approx(0.99040, abs=1e-4)  # cos(3 / 10000^(1/3))


@pytest.mark.parametrize("patch", [1, 4])
@pytest.mark.parametrize("frames", [1, 3, 4, 7])
def test_shapes_at_any_length(patch: int, frames: int) -> None:
    encoder, decoder = (
        ActorEncoder(5, patch=patch, **SMALL).eval(),
        ActorDecoder(5, patch=patch, **SMALL).eval(),
    )
    mask = torch.ones(2, frames, dtype=torch.bool)
    found = encoder(torch.randn(2, frames, 5), mask)
    assert found.mu.shape == found.logvar.shape == (2, 16)
    assert decoder(found.mu, mask).shape == (2, frames, 5)


@pytest.mark.parametrize("patch", [1, 4])
@pytest.mark.parametrize("frames", [1, 5, 8])
def test_padding_changes_nothing(patch: int, frames: int) -> None:
    torch.manual_seed(0)
    model = TMR(text_dim=6, motion_dim=5, patch=patch, **SMALL).eval()
    model.motion_mean.fill_(3.0)
    x, mask = torch.randn(1, frames, 5), torch.ones(1, frames, dtype=torch.bool)
    padded = torch.cat((x, torch.full((1, 6, 5), 99.0)), dim=1)
    longer = torch.cat((mask, torch.zeros(1, 6, dtype=torch.bool)), dim=1)
    short, long = model.encode_motion(x, mask), model.encode_motion(padded, longer)
    torch.testing.assert_close(short.mu, long.mu, atol=1e-5, rtol=1e-5)
    decoded = model.decode(short.mu, longer)
    torch.testing.assert_close(model.decode(short.mu, mask), decoded[:, :frames], atol=1e-5, rtol=1e-5)
    assert (decoded[:, frames:] == 0).all()


def test_patches_join_frames_in_order_and_zero_the_tail() -> None:
    x = torch.arange(1.0, 8.0).reshape(1, 7, 1)
    tokens, mask = patched(x, mask_of(5, 7)[:1], 3)
    assert tokens.tolist() == [[[1.0, 2.0, 3.0], [4.0, 5.0, 0.0], [0.0, 0.0, 0.0]]]
    assert mask.tolist() == [[True, True, False]]


def test_the_ragged_training_path_gives_the_same_numbers_and_gradients() -> None:
    torch.manual_seed(0)
    model = TMR(text_dim=6, motion_dim=5, patch=4, dropout=0.0, **SMALL)
    tokens, token_mask, motion, mask = (
        torch.randn(3, 4, 6),
        mask_of(4, 1, 2),
        torch.randn(3, 9, 5),
        mask_of(9, 1, 6),
    )

    def outcome(training: bool) -> list[torch.Tensor]:
        model.train(training).zero_grad()
        text, moved = model(tokens, token_mask, motion, mask)
        decoded = model.motion_decoder(moved.mu + text.logvar, mask)
        (decoded.pow(3).sum() + (text.mu * moved.logvar).sum()).backward()
        return [*text, *moved, decoded, *(p.grad.clone() for p in model.parameters() if p.grad is not None)]

    for ragged, plain in zip(outcome(True), outcome(False), strict=True):
        torch.testing.assert_close(ragged, plain, atol=2e-4, rtol=1e-3)


def test_dropout_drops_its_rate_and_keeps_the_mean() -> None:
    torch.manual_seed(0)
    kept = Dropout(0.1).train()(torch.ones(1000, 203))
    assert float((kept == 0).float().mean()) == pytest.approx(0.1, abs=0.005)
    assert float(kept.mean()) == pytest.approx(1.0, abs=0.005)
    assert torch.equal(Dropout(0.1).eval()(kept), kept)


def test_a_width_that_the_heads_do_not_divide_is_refused() -> None:
    with pytest.raises(ValueError, match="not a multiple"):
        MultiHeadSelfAttention(10, 4)


@pytest.mark.parametrize(("frames", "halvings"), [(1, 2), (7, 2), (12, 0), (30, 2)])
def test_a_recurrent_encoder_gives_unit_points_that_padding_does_not_change(frames: int, halvings: int) -> None:
    torch.manual_seed(0)
    net, x = GruEncoder(6, d=8, hidden=10, halvings=halvings).eval(), torch.randn(2, 37, 6)
    alone = net(x[:1, :frames], mask_of(frames))
    padded = net(x, mask_of(frames, 37))
    torch.testing.assert_close(padded.mu[:1], alone.mu, atol=1e-6, rtol=1e-5)
    torch.testing.assert_close(padded.mu.norm(dim=-1), torch.ones(2))
    torch.testing.assert_close(padded.sample(), padded.mu, atol=1e-3, rtol=0)


def test_a_recurrent_encoder_without_convolutions_is_torchs_gru_over_the_projected_tokens() -> None:
    torch.manual_seed(0)
    net, x = GruEncoder(6, d=8, hidden=10).eval(), torch.randn(1, 9, 6)
    _, ends = net.gru(torch.nn.functional.leaky_relu(net.project(x), 0.2))
    raw = net.out(net.head(torch.cat((ends[0], ends[1]), dim=-1)))
    torch.testing.assert_close(net(x, mask_of(9)).mu, raw / raw.norm(), atol=1e-6, rtol=1e-5)


def test_hidden_tokens_inside_a_text_count_as_silence_and_not_as_its_end() -> None:
    mask = torch.tensor([[True, False, True, False], [True, False, False, False], [False] * 4])
    assert last_valid(mask).tolist() == [3, 1, 1]


def test_the_rival_is_told_by_its_configuration_and_others_keep_theirs() -> None:
    rival = TMR(d=8, layers=1, heads=2, ff=8, encoder="gru")
    assert isinstance(rival.motion_encoder, GruEncoder)
    again = TMR(**rival.config)
    again.load_state_dict(rival.state_dict())
    assert "encoder" not in TMR(d=8, layers=1, heads=2, ff=8).config
