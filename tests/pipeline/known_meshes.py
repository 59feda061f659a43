# SPDX-License-Identifier: MIT
"""Meshes whose answers are known by hand, as OFF."""

# The cube [0, 2]^3, closed and outward.
CUBE = """OFF
8 6 0
0 0 0
2 0 0
2 2 0
0 2 0
0 0 2
2 0 2
2 2 2
0 2 2
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
"""
