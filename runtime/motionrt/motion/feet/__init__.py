"""Feet on the ground: contacts, planted feet held in place, flat ground, and legs by inverse kinematics."""
