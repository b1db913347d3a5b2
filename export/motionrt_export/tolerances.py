"""What is promised of every variant against the torch module, at all lengths and batches that are tried."""

from __future__ import annotations

from motionrt_export.measures import Figures

_AS_GOOD = {"path_deviation_ratio": 1.05, "foot_skate_ratio": 1.05, "height_cm": 1.0, "waypoints_missed": 0.0}
"""A walk of 1,000 steps: within 5 % of torch's measures, no waypoint fewer."""

FLOAT32: dict[str, Figures] = {
    "sentence_encoder": {
        "token_features": {"max_abs_error": 1e-4},
        "sentence_embedding": {"max_abs_error": 1e-4},
    },
    "tmr_text": {"embedding": {"max_abs_error": 1e-4}, "latent": {"max_abs_error": 1e-3}},
    "tmr_motion": {"embedding": {"max_abs_error": 1e-4}, "latent": {"max_abs_error": 1e-3}},
    "tmr_decoder": {"motion": {"max_abs_error": 1e-3}},  # standard deviations of every feature
    "walknet": {"next": {"max_abs_error": 1e-4}, "walk": {"joints_cm_after_1_s": 0.05, **_AS_GOOD}},
    "transnet": {"motion": {"max_abs_error": 1e-3}, "transition": {"joints_cm": 0.01, "end_cm": 0.01}},
    "pose_prior": {"rotations": {"max_abs_error": 1e-4}},
    "temos_text": {"mu": {"max_abs_error": 1e-3}, "logvar": {"max_abs_error": 1e-3}},
    "temos_motion": {"mu": {"max_abs_error": 1e-3}, "logvar": {"max_abs_error": 1e-3}},
    "temos_decoder": {"motion": {"max_abs_error": 1e-3}, "generation": {"joints_cm": 0.01, "end_cm": 0.05}},
    "latent_denoiser": {
        "clean": {"max_abs_error": 1e-3},
        "latent_out": {"max_abs_error": 1e-3},
        "generation": {"joints_cm": 0.05, "end_cm": 0.1},
    },
}
INT8: dict[str, Figures] = {
    "sentence_encoder": {"token_features": {"cosine_min": 0.98}, "sentence_embedding": {"cosine_min": 0.995}},
    "tmr_text": {"embedding": {"cosine_min": 0.995}, "latent": {"cosine_min": 0.995}},
    "tmr_motion": {"embedding": {"cosine_min": 0.995}, "latent": {"cosine_min": 0.995}},
    "tmr_decoder": {"motion": {"rms_error": 0.03}},  # standard deviations of every feature
    "walknet": {"next": {"rms_error": 0.01}, "walk": {"joints_cm_after_1_s": 3.0, **_AS_GOOD}},
    "transnet": {
        "motion": {"rms_error": 0.01},
        "transition": {"joints_cm": 1.0, "end_cm": 0.5, "foot_skate_ratio": 1.05},
    },
    "temos_text": {"mu": {"cosine_min": 0.995}, "logvar": {"rms_error": 0.05}},
    "temos_motion": {"mu": {"cosine_min": 0.995}, "logvar": {"rms_error": 0.05}},
    "temos_decoder": {
        "motion": {"rms_error": 0.03},
        "generation": {"joints_cm": 1.0, "end_cm": 5.0, "foot_skate_ratio": 1.05},
    },
    "latent_denoiser": {
        "clean": {"rms_error": 0.05},
        "latent_out": {"rms_error": 0.05},
        "generation": {"joints_cm": 2.0, "end_cm": 10.0, "foot_skate_ratio": 1.05},
    },
}
