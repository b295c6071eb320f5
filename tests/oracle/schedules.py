"""Shortest schedules by brute force: every way to start steps, second by second."""

from foon_asp.planning.schedule_task import ScheduleTask


def least_time(task: ScheduleTask) -> int | None:
    """Give the shortest time in which all steps of a small task can be done, ``None`` if they cannot."""
    everything = frozenset(range(len(task.lengths)))
    now = {(frozenset[int](), frozenset[tuple[int, int]]())}  # what is done, and what runs for how long yet
    time, seen = 0, set(now)
    while now:
        later = set()
        for done, running in now:
            for begun in _begun(task, done, running):
                if done | {step for step, _ in begun} == everything and not begun:
                    return time
                over = {step for step, left in begun if left == 1}
                state = done | over, frozenset((step, left - 1) for step, left in begun if left > 1)
                if state not in seen:
                    seen.add(state)
                    later.add(state)
        now, time = later, time + 1
    return None


def _begun(
    task: ScheduleTask, done: frozenset[int], running: frozenset[tuple[int, int]]
) -> list[frozenset[tuple[int, int]]]:
    """Give every way to start none, one or more of the steps that can be started."""
    ways, new = {running}, [running]
    while new:
        way = new.pop()
        for step in range(len(task.lengths)):
            more = way | {(step, task.lengths[step])}
            if _may_start(task, step, done, {each for each, _ in way}) and more not in ways:
                ways.add(more)
                new.append(more)
    return [*ways]


def _may_start(task: ScheduleTask, step: int, done: frozenset[int], running: set[int]) -> bool:
    if step in done or step in running or not task.after[step] <= done:
        return False
    if not task.passive[step] and sum(not task.passive[each] for each in running) == task.agents:
        return False
    if any(step in steps and running.intersection(steps) for steps in task.sharing):
        return False
    mine = [use for use in task.uses if step in use.steps]
    if any(running.intersection(use.steps) for use in mine):
        return False
    begun = done | running
    in_use = [use for use in task.uses if begun.intersection(use.steps) and not done.issuperset(use.steps)]
    fetched = [use for use in mine if not begun.intersection(use.steps)]
    return all(
        sum(use.name == name for use in (*in_use, *fetched)) <= task.counts[name]
        for name in {use.name for use in fetched}
    )
