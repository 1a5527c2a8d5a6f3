"""What --version prints of a tool: the same lines as that of abut."""

import argparse

try:
    from abut_tools.build_info import COMMIT, OPTIONS, VERSION
except ImportError:  # run from the source tree
    VERSION, COMMIT, OPTIONS = "of the source tree", "unknown", "not built"


class TellVersion(argparse.Action):
    """Argparse's own action would fill the lines into one paragraph."""

    def __init__(self, option_strings, dest):
        super().__init__(option_strings, dest=argparse.SUPPRESS, nargs=0,
                         help="print version, commit and options of the build, and exit")

    def __call__(self, parser, namespace, values, option_string=None):
        print(f"{parser.prog} {VERSION}\ncommit   {COMMIT}\nbuild    {OPTIONS}")
        parser.exit()
