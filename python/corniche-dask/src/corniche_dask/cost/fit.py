"""Least squares with coefficients that are not negative."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations


def fit(rows: Sequence[Sequence[float]], values: Sequence[float], weights: Sequence[float]) -> list[float]:
    """Coefficients of the columns, none below 0, with the least sum of ``(weight · (row · coefficients − value))²``.

    Every set of columns is tried; of those whose solution has no negative coefficient, the best is taken. By the conditions of
    Karush, Kuhn and Tucker the optimum is among them. It is meant for a few columns.
    """
    columns = len(rows[0]) if rows else 0
    best, best_error = [0.0] * columns, _error(rows, values, weights, [0.0] * columns)
    for count in range(1, columns + 1):
        for chosen in combinations(range(columns), count):
            solved = _solve([[row[column] for column in chosen] for row in rows], values, weights)
            if solved is None or min(solved) < 0:
                continue
            coefficients = [0.0] * columns
            for column, value in zip(chosen, solved, strict=True):
                coefficients[column] = value
            error = _error(rows, values, weights, coefficients)
            # A column that explains nothing stays out.
            if error < best_error * (1 - 1e-9):
                best, best_error = coefficients, error
    return best


def _error(rows: Sequence[Sequence[float]], values: Sequence[float], weights: Sequence[float], coefficients: Sequence[float]) -> float:
    sums = (sum(cell * factor for cell, factor in zip(row, coefficients, strict=True)) for row in rows)
    return sum((weight * (found - value)) ** 2 for found, value, weight in zip(sums, values, weights, strict=True))


def _solve(rows: Sequence[Sequence[float]], values: Sequence[float], weights: Sequence[float]) -> list[float] | None:
    """The normal equations by Gauss' elimination with pivots; ``None`` if the columns depend on each other."""
    size = len(rows[0])
    # Columns differ by many powers of ten, so each is measured by its largest cell.
    scales = [max(abs(row[column]) for row in rows) or 1.0 for column in range(size)]
    scaled = [[weight * row[column] / scales[column] for column in range(size)] for row, weight in zip(rows, weights, strict=True)]
    wanted = [weight * value for value, weight in zip(values, weights, strict=True)]
    matrix = [
        [sum(row[i] * row[j] for row in scaled) for j in range(size)] + [sum(row[i] * value for row, value in zip(scaled, wanted, strict=True))]
        for i in range(size)
    ]
    largest = max(abs(matrix[i][i]) for i in range(size))
    for i in range(size):
        pivot = max(range(i, size), key=lambda row: abs(matrix[row][i]))
        if abs(matrix[pivot][i]) <= 1e-12 * largest:
            return None
        matrix[i], matrix[pivot] = matrix[pivot], matrix[i]
        for row in range(size):
            if row != i:
                factor = matrix[row][i] / matrix[i][i]
                matrix[row] = [cell - factor * above for cell, above in zip(matrix[row], matrix[i], strict=True)]
    return [matrix[i][size] / matrix[i][i] / scales[i] for i in range(size)]
