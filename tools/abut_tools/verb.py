"""How every verb ends: with what it made, or with words and a code that tell who can help."""

import sys
from collections.abc import Callable

from abut_tools.tables import ToolError


def ended(verb: str, work: Callable[[], int]) -> int:
    """The exit code of the work, or of what stopped it: a ToolError has its own, files have 3."""
    try:
        return work()
    except ToolError as error:
        print(f"abut {verb}: {error}", file=sys.stderr)
        return error.code
    except OSError as error:
        print(f"abut {verb}: {error.filename}: {error.strerror}. Check that it can be read and "
              "written.", file=sys.stderr)
        return 3
