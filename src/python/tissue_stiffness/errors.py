"""Errors of what Python itself reads, in the words of the library's."""
import os

from ._core import InputError


def input_error(where, found, allowed):
    return InputError('%s: found %s; allowed: %s' % (where, found, allowed))


def read_text(file, allowed):
    """Content of a text file; InputError where there is none."""
    try:
        with open(file, encoding='utf-8') as stream:
            return stream.read()
    except (OSError, UnicodeDecodeError) as error:
        raise input_error(os.fspath(file), getattr(error, 'strerror', None) or error, allowed) from None
