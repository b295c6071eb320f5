"""``--cross-check``: the answer held against other engines before it is given out."""

from pathlib import Path

from foon_asp.engines import Asked, DisagreementError, cross_check
from foon_asp.errors import BugError, UserError
from foon_asp.report.cross_check import check_lines, checked_dict
from foon_asp.report.disagreement import disagreement_files, disagreement_name
from foon_asp.report.whole_file import write_whole


def check_across(asked: Asked) -> tuple[list[str], dict[str, object]]:
    """Ask the other engines; give what they say in lines, and as a key of JSON.

    Where one disagrees, writes all that is needed to look into it to a new folder and raises
    :class:`BugError`.
    """
    try:
        checks = cross_check(asked)
    except DisagreementError as found:
        folder = Path(disagreement_name(asked.outcome))
        try:
            for name, content in disagreement_files(asked, found).items():
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                write_whole(folder / name, content.encode("utf-8", "surrogatepass"))
        except (OSError, UserError) as error:  # what was found counts more than where it is written
            raise BugError(f"{found}; the data could not be written to {folder}/: {error}") from None
        raise BugError(f"{found}; data, question and answers are in {folder}/ (see report.json)") from None
    return list(check_lines(asked, checks)), checked_dict(checks)
