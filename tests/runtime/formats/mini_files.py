"""Small motion files, written by hand, whose positions a reader of the tests can check."""

from __future__ import annotations

from pathlib import Path

# A chain: hip at the origin, chest 10 above (+Y), hand 5 to the left (+X) of the chest, tip 2 further.
BVH = """HIERARCHY
ROOT hip
{
\tOFFSET 0 0 0
\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
\tJOINT chest
\t{
\t\tOFFSET 0 10 0
\t\tCHANNELS 3 Zrotation Xrotation Yrotation
\t\tJOINT hand
\t\t{
\t\t\tOFFSET 5 0 0
\t\t\tCHANNELS 3 Zrotation Xrotation Yrotation
\t\t\tEnd Site
\t\t\t{
\t\t\t\tOFFSET 2 0 0
\t\t\t}
\t\t}
\t}
}
MOTION
Frames: 2
Frame Time: 0.033333
0 0 0 0 0 0 0 0 0 0 0 0
1 2 3 90 0 0 0 0 90 0 90 0
"""

ASF = """# a comment
:version 1.10
:name mini
:units
  mass 1.0
  length 0.45
  angle deg
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name lhipjoint
     direction 1 0 0
     length 2
     axis 0 0 0 XYZ
  end
  begin
     id 2
     name lfemur
     direction 0 -1 0
     length 8
     axis 0 0 0 XYZ
     dof rx ry rz
     limits (-160.0 20.0)
            (-70.0 70.0)
            (-60.0 70.0)
  end
  begin
     id 3
     name ltibia
     direction 0 -1 0
     length 7
     axis 0 90 0 XYZ
     dof rx
     limits (-10.0 170.0)
  end
:hierarchy
  begin
    root lhipjoint
    lhipjoint lfemur
    lfemur ltibia
  end
"""

AMC = """#!OML:ASF C:\\mini.asf
:FULLY-SPECIFIED
:DEGREES
1
root 0 15 0 0 0 0
lfemur 0 0 0
ltibia 0
2
root 1 15 2 0 90 0
lfemur -90 0 0
ltibia 90
"""


def write(path: Path, text: str | bytes) -> Path:
    """Write a file byte by byte as given (no translation of line ends)."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(text if isinstance(text, bytes) else text.encode("utf-8"))
    return path


def bvh_of(channels: str, values: str, offset: str = "0 0 0") -> str:
    """A BVH file of one joint called ``hip`` with one End Site 1 above it, and one frame."""
    return f"""HIERARCHY
ROOT hip
{{
OFFSET {offset}
CHANNELS {len(channels.split())} {channels}
End Site
{{
OFFSET 0 1 0
}}
}}
MOTION
Frames: 1
Frame Time: 0.01
{values}
"""
