"""L D L^T of a small symmetric matrix, compiled: its pivots' signs are those of the eigenvalues (Sylvester)."""

from __future__ import annotations

from tensegym.compiled import kernel

from .beam import OPTIONS


@kernel(**OPTIONS)
def factor(matrix):
    """L D L^T in place without pivoting; returns the negative pivots of all but the last, and whether the last is."""
    size = len(matrix)
    negative = 0
    for j in range(size):
        pivot = matrix[j, j]
        for i in range(j + 1, size):
            share = matrix[i, j] / pivot
            for k in range(j + 1, i + 1):
                matrix[i, k] -= share * matrix[k, j]
        for i in range(j + 1, size):
            matrix[i, j] /= pivot
        if pivot < 0 and j < size - 1:
            negative += 1
    return negative, matrix[size - 1, size - 1] < 0


@kernel(**OPTIONS)
def forward(matrix, right):
    """Solve L z = right in place."""
    for i in range(len(right)):
        for k in range(i):
            right[i] -= matrix[i, k] * right[k]


@kernel(**OPTIONS)
def backward(matrix, right):
    """Solve L^T x = right in place."""
    for i in range(len(right) - 1, -1, -1):
        for k in range(i + 1, len(right)):
            right[i] -= matrix[k, i] * right[k]
