"""Functions of the unit cube whose Sobol' indices are known: Ishigami's (a = 7, b = 0.1) and Sobol's g of eight inputs."""
import numpy as np


def ishigami(u):
    x = np.pi * (2 * u - 1)
    return np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


A = np.array([0, 1, 4.5, 9, 99, 99, 99, 99])
parts = np.array([(1 + 0.1 * np.pi**4 / 5) ** 2 / 2, 49 / 8, 0.01 * np.pi**8 * (1 / 18 - 1 / 50)])  # V1, V2, V13
alone = 1 / (3 * (1 + A) ** 2)
#: by the number of inputs: the function, first and total indices
KNOWN = {3: (ishigami, np.array([*parts[:2], 0]) / parts.sum(), np.array([parts[0] + parts[2], parts[1], parts[2]]) / parts.sum()),
         8: (lambda u: np.prod((np.abs(4 * u - 2) + A) / (1 + A), axis=1), alone / (np.prod(1 + alone) - 1),
             alone / (1 + alone) * np.prod(1 + alone) / (np.prod(1 + alone) - 1))}
assert np.allclose(KNOWN[3][2], [0.5576, 0.4424, 0.2437], atol=1e-4) and np.isclose(KNOWN[8][2][0], 0.7871, atol=1e-4)
