"""Least squares with non-negative coefficients."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations


def fit(rows: Sequence[Sequence[float]], values: Sequence[float], weights: Sequence[float]) -> list[float]:
    """Coefficients of the columns, none below 0, with the least sum of ``(weight · (row · coefficients − value))²``.

    Every set of columns is tried; of those whose solution has no negative coefficient, the best is taken. By the conditions of
    Karush, Kuhn and Tucker the optimum is among them. It is meant for a few columns.
    """
    columns = [[weight * cell for cell, weight in zip(column, weights, strict=True)] for column in zip(*rows, strict=True)]
    # Columns differ by many powers of ten, so each is divided by its length.
    lengths = [math.hypot(*column) or 1.0 for column in columns]
    columns = [[cell / length for cell in column] for column, length in zip(columns, lengths, strict=True)]
    wanted = [weight * value for value, weight in zip(values, weights, strict=True)]
    best: dict[int, float] = {}
    best_error = _dot(wanted, wanted)
    for count in range(1, len(columns) + 1):
        for chosen in combinations(range(len(columns)), count):
            solved = _solve([columns[column] for column in chosen], wanted)
            if solved is None or min(solved) < 0:
                continue
            left = wanted
            for column, coefficient in zip(chosen, solved, strict=True):
                left = _without(left, columns[column], coefficient)
            # A column that explains nothing is not used.
            if _dot(left, left) < best_error * (1 - 1e-9):
                best, best_error = dict(zip(chosen, solved, strict=True)), _dot(left, left)
    return [best.get(column, 0.0) / length for column, length in enumerate(lengths)]


def _solve(columns: Sequence[Sequence[float]], values: Sequence[float]) -> list[float] | None:
    """Solves by Gram-Schmidt orthogonalization: removes the component along each column from the rest; ``None`` if columns are dependent."""
    if not columns:
        return []
    first, *others = columns
    square = _dot(first, first)
    if square <= 1e-12:
        return None
    along, *shares = (_dot(first, other) / square for other in (values, *others))
    rest = _solve([_without(other, first, share) for other, share in zip(others, shares, strict=True)], _without(values, first, along))
    return None if rest is None else [along - _dot(shares, rest), *rest]


def _without(values: Sequence[float], column: Sequence[float], factor: float) -> list[float]:
    return [value - factor * cell for value, cell in zip(values, column, strict=True)]


def _dot(one: Sequence[float], other: Sequence[float]) -> float:
    return sum(a * b for a, b in zip(one, other, strict=True))
