"""The memory limit of a worker process, which the system enforces."""

import contextlib


def limit_own_memory(size: int | None) -> None:
    """Limit the data segment of this process to ``size`` bytes; ``None`` removes the limit.

    Nothing is done if the system cannot limit it, or if the system's own limit is lower. The parent process
    only polls the memory of this process, and memory may grow too fast for that.
    """
    try:
        import resource  # noqa: PLC0415 (not on every system)
    except ImportError:
        return
    hard_limit = resource.getrlimit(resource.RLIMIT_DATA)[1]
    with contextlib.suppress(ValueError, OSError):  # not supported, or above the limit of the user
        resource.setrlimit(resource.RLIMIT_DATA, (hard_limit if size is None else size, hard_limit))
