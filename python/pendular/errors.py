"""What calls of pendular raise and warn of; the text names file or argument, field, what was found and expected."""


class Error(Exception):
    """Any error of pendular; `exit_status` is that of the command line for the same mistake."""

    exit_status = 4


class UsageError(Error, ValueError):
    """The call does not make sense: arguments that do not go together, or an output that is an input."""

    exit_status = 2


class InputError(Error, ValueError):
    """A file, an array or another value that was given is wrong."""

    exit_status = 3


class ComputationError(Error, RuntimeError):
    """The input was right but the work failed: diverged, disc full, an effect that threw."""

    exit_status = 4


class PendularWarning(UserWarning):
    """What the command line says after `warning:`."""
