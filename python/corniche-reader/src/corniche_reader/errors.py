"""Why a package or a tile cannot be read. Each message names the part of the file and what is wrong with it."""

from __future__ import annotations


class ReadError(Exception):
    """The base of all errors of this package. Its text is for the user."""


class ContainerError(ReadError):
    """The file is no Corniche package, or its header, directories or metadata are damaged."""


class PayloadError(ReadError):
    """A tile's payload, or one of its sections, is damaged."""


class UnknownTile(ReadError):
    """The package has no such tile."""
