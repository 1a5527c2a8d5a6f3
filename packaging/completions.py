"""Completions of bash and zsh for the programs, from what they say with --help.

usage: completions.py FOLDER-OF-THE-PROGRAMS FOLDER-OF-THE-COMPLETIONS
"""

import sys
from pathlib import Path

from help_text import Help, Item, help_of, verbs_of

HERE = Path(__file__).resolve().parent
KINDS = {"key.path=value": "KEY", "SCENE": "SCENE", "DIR": "DIR", "FILE": "FILE",
         "PROGRAM": "PROGRAM", "KEY": "KEY_PATH", "MESH": "MESH"}
ZSH = {"KEY": "_abut_keys", "KEY_PATH": "_abut_key_paths",
       "MESH": '_files -g "*.(msh|inp)(-.)"', "SCENE": '_files -g "*.yaml(-.)"', "DIR": "_files -/",
       "FILE": "_files", "PROGRAM": "_files", "STUDY": '_files -g "*.yaml(-.)"', "OTHER": " "}


def kind_of(operand: str) -> str:
    """{one,other}: these words; else a name that the completion functions know."""
    if operand.startswith("{"):
        return operand
    return KINDS.get(operand, "OTHER")


def operand_kind(command: str, said: Help) -> str:
    """Of the words beside the options: the first kind that is known. A name comes before it."""
    if command == "abut-study":
        return "STUDY"
    words = [word for item in said.items("arguments") for word in item.term.split()]
    return next((kind_of(word) for word in words if word in KINDS), "OTHER")


def bash_case(command: str, words: list[str]) -> str:
    return f"    {command}) echo \"{' '.join(words)}\" ;;"


def bash_options(said: Help) -> list[str]:
    return [name + (f"={kind_of(item.operand())}" if item.operand() else "")
            for item in said.items("options") for name in item.names()]


def zsh_kind(kind: str) -> str:
    return f"({kind[1:-1].replace(',', ' ')})" if kind.startswith("{") else ZSH[kind]


def quoted(text: str) -> str:
    return "'" + text.replace("'", "'\\''") + "'"


def zsh_option(item: Item) -> list[str]:
    """Specifications of _arguments, one for each name."""
    meaning = item.meaning.replace("[", "(").replace("]", ")").replace(":", ";")
    operand = item.operand()
    word = ""
    if operand:
        name = "word" if operand.startswith("{") else operand.replace(":", " ")
        word = f":{name}:{zsh_kind(kind_of(operand))}"
    many = "*" if "repeatable" in meaning or not word else ""
    return [quoted(f"{many}{name}[{meaning}]{word}") for name in item.names()]


def zsh_case(command: str, said: Help) -> str:
    words = [spec for item in said.items("options") for spec in zsh_option(item)]
    if said.items("arguments"):
        kind = operand_kind(command, said)
        if kind == "MESH":
            words.append(quoted(f"1:name:{ZSH['OTHER']}"))
        place = "*" if kind == "MESH" else "1"
        words.append(quoted(f"{place}:{kind.lower()}:{ZSH[kind]}"))
    lines = " \\\n        ".join(words)
    return f"    {command})\n      _arguments \\\n        {lines} ;;"


def main() -> int:
    programs, out = Path(sys.argv[1]), Path(sys.argv[2])
    verbs = verbs_of(programs)
    commands = {f"abut-{verb}": help_of(programs / "abut", verb) for verb in verbs}
    own = sorted(name for name in [*commands, "abut-solver"] if (programs / name).is_file())
    commands["abut-solver"] = help_of(programs / "abut-solver")
    parts = {
        "completion.bash.in": ("abut", {
            "VERBS": " ".join(verbs),
            "OPTIONS": "\n".join(bash_case(command, bash_options(said))
                                 for command, said in commands.items()),
            "OPERANDS": "\n".join(bash_case(command, [operand_kind(command, said)])
                                  for command, said in commands.items())}),
        "completion.zsh.in": ("_abut", {
            "VERBS": "\n".join("    " + quoted(f"{verb}:{meaning}")
                               for verb, meaning in verbs.items()),
            "COMMANDS": "\n".join(zsh_case(command, said)
                                  for command, said in commands.items())})}
    out.mkdir(parents=True, exist_ok=True)
    for template, (name, filled) in parts.items():
        text = (HERE / template).read_text(encoding="utf-8")
        for key, value in filled.items():
            text = text.replace(f"@{key}@", value)
        text = text.replace("@PROGRAMS@", " ".join(["abut", *own]))
        (out / name).write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
