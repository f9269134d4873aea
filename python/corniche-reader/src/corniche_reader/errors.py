"""Errors of packages and tiles that cannot be read. Each message names the part of the file and the problem."""

from __future__ import annotations


class ReadError(Exception):
    """The base of all errors of this package. The message is meant for the user."""


class ContainerError(ReadError):
    """The file is not a Corniche package, or its header, directories or metadata are corrupt."""


class PayloadError(ReadError):
    """A tile's payload, or one of its sections, is corrupt."""


class UnknownTile(ReadError):
    """The package does not have the requested tile or level."""
