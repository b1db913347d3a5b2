"""Which page shows what."""

from __future__ import annotations

from importlib import import_module

Page = tuple[str, str, tuple[str, ...]]
PAGES: dict[str, Page] = {
    "runtime": ("Runtime", "One object; its verbs are the product.", ("motionrt:Runtime",)),
    "motion": (
        "Motions and files",
        "A motion is a value: 24 joints, metres, Y up. Files go in and out by their suffix.",
        (
            "motionrt:Motion", "motionrt:Skeleton", "motionrt:SMPL24", "motionrt:PARTS", "motionrt:load_motion",
            "motionrt:load_rig", "motionrt:load_target", "motionrt:load_character",
            "motionrt.formats.character:Character", "motionrt.formats.character:Dressed", "motionrt.rigs.skin:Skin",
            "motionrt:save_motion", "motionrt.rigs.clip:RigClip",
            "motionrt.formats:motion_file_info", "motionrt.formats:MotionFileInfo", "motionrt.formats:find_motions",
            "motionrt.formats:animations_of", "motionrt.rigs.certify:certify", "motionrt.rigs.certify:Certificate",
            "motionrt.rigs.certify:ProbeResult", "motionrt.rigs.mapping:draft_mapping",
            "motionrt.rigs.mapping:load_mapping", "motionrt.rigs.mapping:save_mapping",
        ),
    ),
    "search": (
        "Search",
        "What retrieval answers with, and galleries.",
        (
            "motionrt:Gallery", "motionrt:Hit", "motionrt.retrieval:Description", "motionrt.retrieval:Moments",
            "motionrt.retrieval:Moment", "motionrt.retrieval:BuildReport", "motionrt.retrieval:build_gallery",
            "motionrt.retrieval:update_gallery", "motionrt.retrieval:Hits", "motionrt.retrieval:Filter",
            "motionrt.retrieval:Weights", "motionrt.retrieval:Caption", "motionrt.retrieval:find",
            "motionrt.retrieval:Search", "motionrt.retrieval:similar", "motionrt.retrieval:duplicates",
            "motionrt.retrieval:Duplicates", "motionrt.motion.attributes:measure",
            "motionrt.motion.attributes:Attributes", "motionrt.text:parse_query", "motionrt.text:TextAttributes",
            "motionrt.text:agreement", "motionrt.text:Agreement",
        ),
    ),
    "databases": (
        "Libraries in databases",
        "PostgreSQL (extra `postgres`), Milvus (extra `milvus`), or a store of your own.",
        (
            "motionrt.engines:GalleryStore", "motionrt.engines:Nearest", "motionrt.engines:open_store",
            "motionrt.engines:copy_gallery", "motionrt.engines:index_into", "motionrt.engines:IndexReport",
            "motionrt.engines:KnownFile", "motionrt.engines:find_in", "motionrt.engines:PostgresStore",
            "motionrt.engines:MilvusStore",
        ),
    ),
    "generation": (
        "Generation and composition",
        "The verbs are on [Runtime](runtime.md); these are what they take.",
        (
            "motionrt:Layer", "motionrt.synthesis.composing:compose", "motionrt.synthesis.parts:body_parts",
            "motionrt.synthesis.parts:PromptLabeller", "motionrt.synthesis.parts:Endpoint",
        ),
    ),
    "locomotion": (
        "Walking and acting",
        "Scenes, paths, actions, scripts, and what comes back.",
        (
            "motionrt:Scene", "motionrt:Path", "motionrt:Goal", "motionrt:Walk", "motionrt:Performance",
            "motionrt.locomotion:Segment", "motionrt.locomotion:PerformanceMeasures", "motionrt:WalkTo",
            "motionrt:Follow", "motionrt:Act", "motionrt:Do", "motionrt:Stand", "motionrt:Wait", "motionrt:Script",
            "motionrt.locomotion:Generate", "motionrt.locomotion:Lie",
            "motionrt.locomotion:Agent", "motionrt.locomotion:Waypoints", "motionrt.locomotion:PoseSolution",
            "motionrt.locomotion:Crowd", "motionrt.locomotion:Stream", "motionrt.locomotion:Wish",
            "motionrt.locomotion:around_others",
            "motionrt.locomotion:SemanticCloud", "motionrt.locomotion:load_cloud", "motionrt.metrics:penetration",
            "motionrt.metrics:Penetration", "motionrt.study:find_pairs", "motionrt.study:Pair",
            "motionrt.study:write_study", "motionrt.study:count_votes", "motionrt.study:Count",
        ),
    ),
    "pictures": (
        "Pictures",
        "Needs the extra `render`.",
        (
            "motionrt:render", "motionrt.rendering:picture", "motionrt.rendering:Look", "motionrt.rendering:Colours",
            "motionrt.rendering:Take", "motionrt.rendering:Mark",
        ),
    ),
}  # fmt: skip
"""Of every page its title, a line about it, and what stands on it, each as module:name."""
UNLISTED = {"__version__", "errors", "MotionRTError"}
"""The version explains itself, errors have a page."""


def missing() -> list[str]:
    """Names of ``motionrt.__all__`` that stand on no page."""
    listed = {
        place.split(":")[1] for _, _, places in PAGES.values() for place in places if place.startswith("motionrt:")
    }
    return sorted(set(import_module("motionrt").__all__) - listed - UNLISTED)
