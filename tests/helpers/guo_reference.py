"""Guo's features as his formulas say them: frame by frame, quaternion by quaternion; shares nothing with the package.

Written from the description of the published pipeline: uniform skeleton, floor, origin, initial facing, inverse
kinematics (hips exchanged, frame 0 without a root rotation, chains that start at the root), contacts, local frames.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from scipy.ndimage import gaussian_filter1d

CHAINS = [[0, 2, 5, 8, 11], [0, 1, 4, 7, 10], [0, 3, 6, 9, 12, 15], [9, 14, 17, 19, 21], [9, 13, 16, 18, 20]]
X, Y, Z = np.eye(3)
REST = [0 * X, X, -X, Y, -Y, -Y, Y, -Y, -Y, Y, Z, Z, Y, X, -X, Z, -Y, -Y, -Y, -Y, -Y, -Y]
LENGTHS = [
    0, 0.10307395, 0.10988335, 0.13156825, 0.39362314, 0.39018813, 0.14319026, 0.43243298, 0.42564332, 0.057364706,
    0.14338174, 0.14941867, 0.21936, 0.13748683, 0.14338283, 0.10303927, 0.13161398, 0.1229843, 0.25683984, 0.26309186,
    0.26601186, 0.2698763,
]  # fmt: skip
LEFT_FOOT, RIGHT_FOOT = (7, 10), (8, 11)


def qmul(p, q):
    (a, b, c, d), (e, f, g, h) = p, q
    return np.array(
        [a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g, a * g - b * h + c * e + d * f,
         a * h + b * g - c * f + d * e]
    )  # fmt: skip


def qinv(q):
    return q * np.array([1, -1, -1, -1])


def qrot(q, v):
    return qmul(qmul(q, np.array([0, *v])), qinv(q))[1:]


def qbetween(u, v):
    q = np.array([math.sqrt((u @ u) * (v @ v)) + u @ v, *np.cross(u, v)])
    return q / np.linalg.norm(q)


def unit(v):
    return v / np.linalg.norm(v)


def root_quaternions(joints, smooth):
    forward = []
    for pose in joints:
        across = (pose[1] - pose[2]) + (pose[17] - pose[16])  # the hips' ends exchanged
        forward.append(np.cross(Y, unit(across)))
    forward = np.array(forward)
    if smooth:
        forward = gaussian_filter1d(forward, 20, axis=0, mode="nearest")
    found = [qbetween(unit(direction), Z) for direction in forward]
    found[0] = np.array([1.0, 0, 0, 0])
    return found


def inverse_kinematics(joints, smooth):
    roots = root_quaternions(joints, smooth)
    local = np.zeros((len(joints), 22, 4))
    for frame, pose in enumerate(joints):
        local[frame, 0] = roots[frame]
        for chain in CHAINS:
            turned = roots[frame]
            for before, joint in pairwise(chain):
                own = qmul(qinv(turned), qbetween(REST[joint], unit(pose[joint] - pose[before])))
                local[frame, joint] = own
                turned = qmul(turned, own)
    return local


def forward_kinematics(local, root, lengths):
    joints = np.zeros((len(local), 22, 3))
    for frame in range(len(local)):
        joints[frame, 0] = root[frame]
        for chain in CHAINS:
            turned = local[frame, 0]
            for before, joint in pairwise(chain):
                turned = qmul(turned, local[frame, joint])
                joints[frame, joint] = joints[frame, before] + qrot(turned, REST[joint] * lengths[joint])
    return joints


def uniform_skeleton(joints):
    leg = np.linalg.norm(joints[0, 5] - joints[0, 2]) + np.linalg.norm(joints[0, 8] - joints[0, 5])
    scale = (LENGTHS[5] + LENGTHS[8]) / leg
    return forward_kinematics(inverse_kinematics(joints, smooth=False), joints[:, 0] * scale, LENGTHS)


def process(joints):
    """Features ``(F - 1, 263)`` and placed joints ``(F, 22, 3)`` of joints ``(F, 22, 3)``."""
    joints = uniform_skeleton(np.asarray(joints, dtype=float))
    joints[..., 1] -= joints[..., 1].min()
    joints = joints - joints[0, 0] * np.array([1, 0, 1])
    first = joints[0]
    facing = qbetween(unit(np.cross(Y, unit(first[2] - first[1] + first[17] - first[16]))), Z)
    joints = np.array([[qrot(facing, joint) for joint in pose] for pose in joints])
    local = inverse_kinematics(joints, smooth=True)
    return np.array([row(joints, local, frame) for frame in range(len(joints) - 1)]), joints


def row(joints, local, frame):
    now, after = joints[frame], joints[frame + 1]
    root, next_root = local[frame, 0], local[frame + 1, 0]
    velocity = qrot(next_root, after[0] - now[0])
    seen = [qrot(root, joint - now[0] * np.array([1, 0, 1])) for joint in now]
    contacts = [float(((after[j] - now[j]) ** 2).sum() < 0.002) for j in LEFT_FOOT + RIGHT_FOOT]
    return np.concatenate(
        [
            [math.asin(qmul(next_root, qinv(root))[2]), velocity[0], velocity[2], seen[0][1]],
            np.concatenate(seen[1:]),
            np.concatenate([sixd(q) for q in local[frame, 1:]]),
            np.concatenate([qrot(root, after[j] - now[j]) for j in range(22)]),
            contacts,
        ]
    )


def sixd(q):
    return np.concatenate([qrot(q, X), qrot(q, Y)])


def recover(rows):
    """Joints ``(F, 22, 3)`` of features ``(F, 263)``, as the published formula has them."""
    angle, place, out = 0.0, np.zeros(3), []
    for frame, features in enumerate(rows):
        if frame:
            angle += rows[frame - 1][0]
        back = np.array([math.cos(angle), 0, -math.sin(angle), 0])  # the inverse of the root's quaternion
        if frame:
            place = place + qrot(back, np.array([rows[frame - 1][1], 0, rows[frame - 1][2]]))
        joints = [np.array([place[0], features[3], place[2]])]
        joints += [qrot(back, local) + place for local in features[4:67].reshape(21, 3)]
        out.append(joints)
    return np.array(out)
