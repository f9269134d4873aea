"""Options of the program as keyword arguments in Python."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Set
from decimal import Decimal
from numbers import Integral, Rational, Real

from .errors import UsageError

#: Options whose value is several numbers with commas. A test compares them with the program.
ONE_VALUE = frozenset({"at", "bounds", "cell", "classes", "height_range", "look_at"})


def words_of(options: Mapping[str, object]) -> list[str]:
    """The arguments of a command line: ``{"max_error": 2.5}`` becomes ``--max-error=2.5``.

    ``True`` gives an option without a value; ``None`` and ``False`` omit the option. A tuple is one value with commas: ``cell=(10, 12)``. Any other
    iterable, such as a list, a generator or an array, repeats the option for each item; for options in :data:`ONE_VALUE` it is one value with commas.

    :raises UsageError: for a type that cannot be a value, such as a dictionary
    """
    words = []
    for name, value in options.items():
        option = "--" + name.rstrip("_").replace("_", "-")
        for one in _values(name, value):
            if isinstance(one, bool):
                words += [option] if one else []
            elif one is not None:
                # With "=", a value that begins with a hyphen is not read as an option.
                words.append(f"{option}={_text(name, one)}")
    return words


def word_of_path(path: str | os.PathLike[str]) -> str:
    """A path as an argument of a command line, where a leading hyphen would make it an option."""
    word = os.fspath(path)
    return f"./{word}" if word.startswith("-") else word


def _values(name: str, value: object) -> list[object]:
    """The values of an option: one for each time that the option is repeated."""
    if isinstance(value, tuple) or not _is_iterable(value):
        return [_plain(value)]
    assert isinstance(value, Iterable)
    items = [_plain(one) for one in value]
    return [tuple(items)] if name in ONE_VALUE else items


def _is_iterable(value: object) -> bool:
    # Sets are not accepted: they have no order, and the order of files matters.
    is_other = isinstance(value, str | bytes | os.PathLike | Mapping | Set)
    # An array without dimensions is a number, although it claims to be iterable.
    return isinstance(value, Iterable) and not is_other and getattr(value, "ndim", 1) > 0


def _plain(value: object) -> object:
    """Converts a truth value of numpy to one of Python."""
    is_truth = getattr(getattr(value, "dtype", None), "kind", None) == "b" and getattr(value, "ndim", None) == 0
    return bool(value) if is_truth else value


def _text(name: str, value: object) -> str:
    if isinstance(value, tuple):
        return ",".join(_text_of_one(name, value, one) for one in value)
    return _text_of_one(name, value, value)


def _text_of_one(name: str, value: object, one: object) -> str:
    if isinstance(one, os.PathLike):
        return str(os.fspath(one))
    is_number = isinstance(one, Real | Decimal) or getattr(one, "ndim", None) == 0
    if isinstance(one, bool) or not (isinstance(one, str) or is_number):
        raise UsageError(f"{name}={value!r} cannot be the value of an option; give a text, a path, a number, or a list or tuple of these")
    # The text of a fraction, such as 5/2, is not a number for the program.
    return str(float(one)) if isinstance(one, Rational) and not isinstance(one, Integral) else str(one)
