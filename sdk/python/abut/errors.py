"""What a body may raise, and what becomes of it."""


class InputError(Exception):
    """The user's: a key that is missing or impossible. The run ends with exit code 2."""

    def __init__(self, what: str, where: str, remedy: str):
        super().__init__(f"{where}: {what}. {remedy}")
        self.what, self.where, self.remedy = what, where, remedy


class NotConverged(Exception):
    """The numbers': a step could not be made. The scene's policy decides, as of bodies of abut: the
    window is cut, or the run ends; the body serves on from the state that it had saved."""


class Unsound(Exception):
    """The coordinator's: a request that this body does not take, or that is not whole."""
