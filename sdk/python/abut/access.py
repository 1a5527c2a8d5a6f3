"""Who may be spoken with: endpoints on a network and files of keys, refused as abut-solver does."""

import os
import re
import stat
import sys
from typing import NamedTuple

import zmq

from abut.errors import InputError

LONGEST_FILE = 4096  # [B]
OF_OTHERS, WRITTEN_BY_OTHERS = 0o077, 0o022
NUMBER = r"(?:0|[1-9][0-9]{0,2})"
LOOPBACK = re.compile(rf"127(?:\.{NUMBER}){{3}}", re.ASCII)
AS_WRITTEN = "Give a file that abut keygen has written, as it was written."


class BodyKeys(NamedTuple):
    """[Z85] of CURVE."""

    public: bytes
    secret: bytes
    coordinator: bytes  # public


def is_local(endpoint: str) -> bool:
    """Whether no other machine can reach it. In doubt it is not."""
    if endpoint.startswith("ipc://"):
        return True
    host, colon, _ = endpoint.removeprefix("tcp://").rpartition(":")
    if not endpoint.startswith("tcp://") or not colon:
        return False
    loopback = LOOPBACK.fullmatch(host) and all(int(each) < 256 for each in host.split("."))
    return host == "localhost" or bool(loopback)


def require_closed_endpoint(endpoint: str, keys: str | None, insecure: bool):
    """Refuses a network without keys, unless the user insists; then it is said on every start."""
    if keys or is_local(endpoint):
        return
    if not insecure:
        raise InputError(
            f"{endpoint} is on a network, where anybody could read and answer what is sent",
            "--connect", "Give --keys DIR, with keys that abut keygen has made, or --insecure on a "
            "network that you trust.")
    print(f"warning: --insecure: whoever is at {endpoint} can read and answer what is sent",
          file=sys.stderr, flush=True)


def read_body_keys(folder: str, body: str) -> BodyKeys:
    """Raises InputError where a file is missing, is no key, or may be read (a secret one) or
    written by others."""
    if not zmq.has("curve"):
        raise InputError("keys cannot be used: libzmq was built without CURVE", "--keys",
                         "Install a libzmq with CURVE, as Debian's libzmq5 is.")
    if body == "coordinator" or not re.fullmatch(r"[A-Za-z0-9_-]+", body):
        raise InputError(f"'{body}' can be no body with a key", "--body",
                         "Use letters, digits, _ and - alone; coordinator is the name of the "
                         "other end.")
    path = f"{folder}/{body}.key_secret"
    text = read_closed(folder, path, secret=True)
    public, secret = find_key(text, "public-key", path), find_key(text, "secret-key", path)
    if zmq.curve_public(secret) != public:
        raise InputError("holds a public key that does not belong to its secret one", path,
                         AS_WRITTEN)
    path = f"{folder}/coordinator.key"
    return BodyKeys(public, secret,
                    find_key(read_closed(folder, path, secret=False), "public-key", path))


def require_closed_file(about: os.stat_result, path: str, secret: bool):
    """Who may change a public key lets in whom he likes; who reads a secret one is its body."""
    if about.st_uid not in (os.geteuid(), 0):
        raise InputError("belongs to another user", path,
                         f"Make it this user's: chown {os.geteuid()} {path}.")
    if about.st_mode & (OF_OTHERS if secret else WRITTEN_BY_OTHERS):
        how, close = ("read or written", "go-rwx") if secret else ("written", "go-w")
        raise InputError(f"may be {how} by other users: its permissions are "
                         f"{about.st_mode & 0o777:03o}", path,
                         f"Close it: chmod {close} {path}.")


def opened(path: str, flags: int, remedy: str) -> int:
    try:
        return os.open(path, os.O_RDONLY | os.O_CLOEXEC | flags)
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}", path, remedy) from error


def read_closed(folder: str, path: str, secret: bool) -> str:
    above = opened(folder, os.O_DIRECTORY, f"Make keys: abut keygen {folder} BODY ...")
    try:
        require_closed_file(os.fstat(above), folder, secret=False)
    finally:
        os.close(above)
    file = opened(path, os.O_NONBLOCK, f"Make keys with abut keygen {folder} BODY ..., and copy "
                                       "this file from where they were made.")
    try:
        about = os.fstat(file)
        if not stat.S_ISREG(about.st_mode):
            raise InputError("is no file", path, "Give a directory that abut keygen has made.")
        require_closed_file(about, path, secret)
        return os.read(file, LONGEST_FILE).decode("utf-8", "replace")
    finally:
        os.close(file)


def find_key(text: str, name: str, path: str) -> bytes:
    """The value of a line `name = "value"`, which must be a key."""
    found = re.search(rf'^[ \t]*{name}[^"\n]*"([!-~]{{40}})"[^"\n]*$', text, re.MULTILINE)
    key = found[1].encode() if found else b""
    try:
        zmq.curve_public(key)  # which decodes it
    except (ValueError, zmq.ZMQError):
        key = b""
    if not key:
        raise InputError(f"has no {name}", path, AS_WRITTEN)
    return key
