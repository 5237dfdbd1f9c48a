"""Writes the mesh of a square block for CalculiX or Abaqus: python3 mesh.py ELEMENTS SIZE [DISTORT] >mesh.inp

ELEMENTS x ELEMENTS of type CPE8R (set BLOCK), nodes in the sets ALL, BOTTOM, TOP and RIM (all of the boundary). DISTORT:
by how much of an element's size inner corners are moved, for a patch test.

The plates, BOTTOM and TOP, stay straight and level: with X from the left, u1 = X/SIZE * w on both, and on TOP besides
u1 += shift, u2 = h, where w is degree 1 of node 100001 (set WIDTH), shift and h degrees 1 and 2 of node 100002 (SHIFT).
"""
import math
import sys

n, size, distort = int(sys.argv[1]), float(sys.argv[2]), float((sys.argv + ["0"])[3])
side = 2 * n + 1  # nodes of a side


def place(i, j):
    if i % 2 or j % 2:  # in the middle of a straight edge
        ends = [(i - i % 2, j - j % 2), (i + i % 2, j + j % 2)]
        return [sum(x) / 2 for x in zip(*(place(*end) for end in ends))]
    inner = 0 < i < side - 1 and 0 < j < side - 1
    turn = 2.4 * (i + side * j)  # the golden angle, nearly: no two neighbours move alike
    move = distort * size / n if inner else 0
    return [size * i / (side - 1) + move * math.cos(turn), size * j / (side - 1) + move * math.sin(turn)]


def number(i, j):
    return i + side * j + 1


nodes = {(i, j): place(i, j) for j in range(side) for i in range(side) if not (i % 2 and j % 2)}
last = side - 1


def print_set(name, wanted):
    print(f"*NSET, NSET={name}")
    print("\n".join(f"{number(i, j)}," for i, j in nodes if wanted(i, j)))


print("*NODE, NSET=ALL")
print("\n".join(f"{number(i, j)}, {x:.12g}, {y:.12g}, 0." for (i, j), (x, y) in nodes.items()))
print("*ELEMENT, TYPE=CPE8R, ELSET=BLOCK")
corners = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
for e in range(n * n):
    i, j = 2 * (e % n), 2 * (e // n)
    print(", ".join(map(str, [e + 1] + [number(i + a, j + b) for a, b in corners])))
print_set("BOTTOM", lambda i, j: j == 0)
print_set("TOP", lambda i, j: j == last)
print_set("RIM", lambda i, j: i in (0, last) or j in (0, last))
print("*NODE, NSET=WIDTH\n100001, 0., 0., 0.\n*NODE, NSET=SHIFT\n100002, 0., 0., 0.")
for i in range(side):
    across = f"100001, 1, {-i / last:.12g}"
    if i:
        print(f"*EQUATION\n2\n{number(i, 0)}, 1, 1., {across}")
    terms = f"{number(i, last)}, 1, 1., 100002, 1, -1."
    print(f"*EQUATION\n3\n{terms}, {across}" if i else f"*EQUATION\n2\n{terms}")
    print(f"*EQUATION\n2\n{number(i, last)}, 2, 1., 100002, 2, -1.")
