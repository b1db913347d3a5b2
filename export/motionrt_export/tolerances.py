"""What is promised of every variant against the torch module, at all lengths and batches that are tried."""

from __future__ import annotations

from motionrt_export.measures import Figures

FLOAT32: dict[str, Figures] = {
    "sentence_encoder": {
        "token_features": {"max_abs_error": 1e-4},
        "sentence_embedding": {"max_abs_error": 1e-4},
    },
    "tmr_text": {"embedding": {"max_abs_error": 1e-4}, "latent": {"max_abs_error": 1e-3}},
    "tmr_motion": {"embedding": {"max_abs_error": 1e-4}, "latent": {"max_abs_error": 1e-3}},
    "tmr_decoder": {"motion": {"max_abs_error": 1e-3}},  # standard deviations of every feature
}
INT8: dict[str, Figures] = {
    "sentence_encoder": {"token_features": {"cosine_min": 0.98}, "sentence_embedding": {"cosine_min": 0.995}},
    "tmr_text": {"embedding": {"cosine_min": 0.995}, "latent": {"cosine_min": 0.995}},
    "tmr_motion": {"embedding": {"cosine_min": 0.995}, "latent": {"cosine_min": 0.995}},
    "tmr_decoder": {"motion": {"rms_error": 0.03}},  # standard deviations of every feature
}
