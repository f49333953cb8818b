"""The end of a tool whose output nobody reads any more, as with `| head`: quiet, as that of other programs."""

from __future__ import annotations

import os
import select
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def readers_may_go() -> Iterator[None]:
    """A reader of stdout that goes away ends what runs inside without a word; a pipe to another program does not."""
    try:
        yield
    except BrokenPipeError:
        if not _reader_has_gone():
            raise
    finally:
        try:
            sys.stdout.flush()
        except BrokenPipeError:  # the interpreter would try again at its end
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _reader_has_gone() -> bool:
    poll = select.poll()
    poll.register(sys.stdout.fileno(), select.POLLOUT)
    return any(event & select.POLLERR for _, event in poll.poll(0))
