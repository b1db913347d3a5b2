"""What is promised of every variant against the torch module, at all lengths and batches that are tried."""

from __future__ import annotations

from motionrt_export.measures import Figures
from motionrt_export.optimise import FP16, FP32, QUANTISED

_AS_GOOD = {"path_deviation_ratio": 1.05, "foot_skate_ratio": 1.05, "height_cm": 1.0, "waypoints_missed": 0.01}
"""A walk of 1,000 steps: within 5 % of torch's measures and 1 % of its waypoints, both beyond two standard errors."""
_SAME_STEPS = {"step_cm": 0.005, "worst_step_cm": 0.05, "pull_cm_per_s": 0.05}
_STEPS = {"step_cm": 0.1, "worst_step_cm": 1.0, "pull_cm_per_s": 0.5}
"""Single steps from the same frames: measured of int8 are 0.03 cm, 0.24 cm and 0.2 cm/s."""

FLOAT32: dict[str, Figures] = {
    "tmr_text": {
        "embedding": {"max_abs_error": 1e-4},
        "latent": {"max_abs_error": 1e-3},
        "token_features": {"max_abs_error": 1e-4},
        "sentence_embedding": {"max_abs_error": 1e-4},
    },
    "tmr_student": {"embedding": {"max_abs_error": 1e-4}, "latent": {"max_abs_error": 1e-3}},
    "tmr_motion": {"embedding": {"max_abs_error": 1e-4}, "latent": {"max_abs_error": 1e-3}},
    "tmr_decoder": {"motion": {"max_abs_error": 1e-3}},  # standard deviations of every feature
    "walknet": {"next": {"max_abs_error": 1e-4}, "walk": {"joints_cm_after_1_s": 0.05, **_SAME_STEPS, **_AS_GOOD}},
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
    "motion_denoiser": {
        "clean": {"max_abs_error": 1e-3},
        "motion": {"max_abs_error": 1e-3},
        "generation": {"joints_cm": 0.05, "end_cm": 0.2},
    },
}
_ROUNDED = 10.0  # times what float32 may be off
FLOAT16: dict[str, Figures] = {
    model: {
        output: {key: limit * (1.0 if key in _AS_GOOD else _ROUNDED) for key, limit in limits.items()}
        for output, limits in outputs.items()
    }
    for model, outputs in FLOAT32.items()
} | {
    "tmr_text": {
        "embedding": {"cosine_min": 0.9999},
        "latent": {"cosine_min": 0.9999},
        "token_features": {"cosine_min": 0.9999},
        "sentence_embedding": {"cosine_min": 0.9999},
    },
    "tmr_student": {"embedding": {"cosine_min": 0.9999}, "latent": {"cosine_min": 0.9999}},
}
"""Released weights are float16 already; only the sentence encoder, and what graphs add to the others, is rounded."""
INT8: dict[str, Figures] = {
    "tmr_text": {
        "alone": {"cosine_min": 0.995},  # embeddings of texts one by one, as the runtime feeds them
        "embedding": {"cosine_min": 0.99},  # in batches, whose rows share a scale
        "latent": {"cosine_min": 0.99},
        "token_features": {"cosine_min": 0.98},
        "sentence_embedding": {"cosine_min": 0.995},
    },
    "tmr_student": {
        "alone": {"cosine_min": 0.995},
        "embedding": {"cosine_min": 0.99},
        "latent": {"cosine_min": 0.99},
    },
    "tmr_motion": {"embedding": {"cosine_min": 0.995}, "latent": {"cosine_min": 0.995}},
    "tmr_decoder": {"motion": {"rms_error": 0.03}},  # standard deviations of every feature
    "walknet": {"next": {"rms_error": 0.01}, "walk": {"joints_cm_after_1_s": 3.0, **_STEPS, **_AS_GOOD}},
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
    "motion_denoiser": {
        "clean": {"rms_error": 0.05},
        "motion": {"rms_error": 0.05},
        "generation": {"joints_cm": 4.0, "end_cm": 20.0, "foot_skate_ratio": 1.05},
    },
}

_SAME_WORK = {"segments_missed": 0.0, "seconds_ratio": 1.05, "path_deviation_ratio": 1.05, "foot_skate_ratio": 1.05}
PIPELINES: dict[str, dict[str, Figures]] = {
    "composition": {
        FP32: {"composition": {"joints_cm": 0.05, "end_cm": 0.2, "foot_skate_ratio": 1.01, "other_parts_percent": 1.0}},
        QUANTISED: {
            "composition": {"joints_cm": 3.0, "end_cm": 12.0, "foot_skate_ratio": 1.05, "other_parts_percent": 8.0}
        },
    },
    "performance": {
        FP32: {"performance": {**_SAME_WORK, "keypoint_ratio": 1.02, "end_cm": 5.0}},
        QUANTISED: {"performance": {**_SAME_WORK, "keypoint_ratio": 1.05, "end_cm": 20.0}},
    },
}
"""What files make together, beside torch."""


def tolerance(model: str, variant: str) -> Figures:
    """What is promised of a variant; ValueError where there is no such model or variant."""
    promised = {FP32: FLOAT32, FP16: FLOAT16, QUANTISED: INT8}
    if model not in promised.get(variant, {}):
        raise ValueError(f"nothing is promised of {model}, {variant}: the models are {', '.join(FLOAT32)}")
    return promised[variant][model]


def pipeline_tolerance(pipeline: str, variant: str) -> Figures:
    """What is promised of a pipeline with all files of a variant; where a model has no such file, with its default."""
    limits = PIPELINES[pipeline]
    return limits[QUANTISED if variant == QUANTISED else FP32]
