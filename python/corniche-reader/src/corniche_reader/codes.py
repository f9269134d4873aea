"""The codes of section 4 of the format: varints, zigzag numbers, planes, range-coded bits."""

from __future__ import annotations

import math

import numpy as np

from .errors import PayloadError

#: A model: how likely a 0 is, as two estimates (fast, slow) in 65536ths.
Model = list[int]
LEAST, LARGEST = 48, 65_488


def models(count: int) -> list[Model]:
    """Returns `count` new models."""
    return [[1 << 15, 1 << 15] for _ in range(count)]


def half_octave(x: int) -> int:
    """0 for 0, 1 for 1, else twice the exponent plus the digit behind the leading 1."""
    if x < 2:
        return x
    e = x.bit_length() - 1
    return 2 * e + (x >> (e - 1) & 1)


def round_half_away(x: float) -> int:
    """The nearest whole number; a half is rounded away from 0."""
    whole = math.floor(abs(x))
    return int(math.copysign(whole + (abs(x) - whole >= 0.5), x))


def unzigzag(n: int) -> int:
    """0, 1, 2, 3 … become 0, −1, 1, −2 …"""
    return (n >> 1) ^ -(n & 1)


class _Whole:
    """Bytes that must be read in order and to the end."""

    def __init__(self, data: bytes, what: str, at: int) -> None:
        self.data, self.what, self.at = data, what, at

    def error(self, text: str) -> PayloadError:
        """The error that something is wrong with the bytes."""
        return PayloadError(f"{self.what}: {text}")

    def end(self) -> None:
        """Rejects bytes that were not read."""
        if self.at != len(self.data):
            raise PayloadError(f"{self.what} has {len(self.data) - self.at} bytes too many")


class Cursor(_Whole):
    """Reads bytes in order, never beyond the end."""

    def __init__(self, data: bytes, what: str) -> None:
        super().__init__(data, what, 0)

    def take(self, count: int) -> bytes:
        """The next bytes."""
        end = self.at + count
        if count < 0 or end > len(self.data):
            raise PayloadError(f"{self.what} ends too early, at byte {len(self.data)}")
        taken, self.at = self.data[self.at : end], end
        return taken

    def byte(self) -> int:
        """The next byte."""
        return self.take(1)[0]

    def word(self, width: int) -> int:
        """A little-endian number of `width` bytes."""
        return int.from_bytes(self.take(width), "little")

    def varint(self) -> int:
        """A varint (base 128)."""
        value = 0
        for shift in range(0, 70, 7):
            byte = self.byte()
            value |= (byte & 127) << shift
            if byte < 128:
                if value >> 64:
                    break
                return value
        raise self.error("a number has more than 64 bits")

    def planes(self, count: int) -> list[int]:
        """Numbers stored as planes of bytes, the lowest byte first."""
        width = self.byte()
        if width > 8:
            raise self.error(f"planes of {width} bytes")
        values = np.zeros(count, np.uint64)
        for plane in range(width):
            values |= np.frombuffer(self.take(count), np.uint8).astype(np.uint64) << np.uint64(8 * plane)
        return values.tolist()


class Bits(_Whole):
    """A string of range-coded bits."""

    def __init__(self, data: bytes, what: str) -> None:
        if len(data) < 4:
            raise PayloadError(f"{what}: its bits end too early")
        super().__init__(data, what, 4)
        self.range, self.code = 0xFFFF_FFFF, int.from_bytes(data[:4], "big")

    def _next(self, bound: int) -> int:
        if self.code < bound:
            self.range, bit = bound, 0
        else:
            self.code -= bound
            self.range -= bound
            bit = 1
        while self.range < 1 << 24:
            if self.at >= len(self.data):
                raise self.error("its bits end too early")
            self.range <<= 8
            self.code = self.code << 8 | self.data[self.at]
            self.at += 1
        return bit

    def even(self) -> int:
        """A bit without a model."""
        return self._next(self.range >> 1)

    def bit(self, model: Model) -> int:
        """A bit with a model."""
        p = model[0] + model[1] >> 1
        bit = self._next((self.range >> 16) * min(max(p, LEAST), LARGEST))
        learn(model, bit)
        return bit

    def mixed(self, one: Model, other: Model) -> int:
        """A bit with two models."""
        p = one[0] + one[1] + other[0] + other[1] >> 2
        bit = self._next((self.range >> 16) * min(max(p, LEAST), LARGEST))
        learn(one, bit)
        learn(other, bit)
        return bit


def learn(model: Model, bit: int) -> None:
    """Updates a model with the bit that was read."""
    fast, slow = model
    if bit:
        model[0] = fast - (fast >> 4)
        model[1] = slow - (slow >> 7)
    else:
        model[0] = fast + (65_535 - fast >> 4)
        model[1] = slow + (65_535 - slow >> 7)


class Numbers:
    """The models for one kind of numbers."""

    def __init__(self, bits: Bits, first: int, second: int) -> None:
        self.bits = bits
        self.x = [models(32) for _ in range(first)]
        self.y = [models(32) for _ in range(second)]
        self.z = [models(4) for _ in range(33)]

    def read(self, first: int = 0, second: int = 0) -> int:
        """The next number; contexts above the largest count as the largest."""
        m = self.unsigned(first, second)
        return -m if m and self.bits.even() else m

    def unsigned(self, first: int = 0, second: int = 0) -> int:
        """The next unsigned number."""
        bits = self.bits
        x, y = self.x[min(first, len(self.x) - 1)], self.y[min(second, len(self.y) - 1)]
        length = 0
        while length < 32 and bits.mixed(x[length], y[length]):
            length += 1
        if length == 0:
            return 0
        m, z = 1, self.z[length]
        for _ in range(length - 1):
            m = 2 * m + (bits.bit(z[m]) if m < 4 else bits.even())
        return m
