"""``foon-asp completion``: scripts by which shells ask for the completions of a command line."""

import os
import re

import click
from click.shell_completion import (
    CompletionItem,
    ShellComplete,
    add_completion_class,
    shell_complete,
    split_arg_string,
)

from foon_asp.cli import shared_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.verbs import SHELL_REQUEST
from foon_asp.errors import UserError
from foon_asp.escapes import escaped

_LINE_VARIABLE = "FOON_ASP_LINE"  # in the environment: the line up to the cursor


class _Shell(ShellComplete):
    """A shell that receives completions, one on each line; without completions, it completes file names.

    This replaces the scripts of click, which split completions at the commas and blanks of names.
    """

    def get_completion_args(self) -> tuple[list[str], str]:
        """Return the words after the name of the program, and the incomplete word at the cursor."""
        *words, typed = split_arg_string(
            f"{os.environ[_LINE_VARIABLE]}x"
        )  # x: the last word is begun even if empty
        return words[1:], typed[:-1]

    def get_completions(self, args: list[str], incomplete: str) -> list[CompletionItem[str]]:
        """Return the distinct completions of the word ``incomplete``, at most ``MAX_COMPLETIONS``.

        Completions of ``--option=word`` begin with ``--option=``. If the data cannot be read, the list is
        empty.
        """
        from foon_asp.cli.completed_words import MAX_COMPLETIONS

        option, equals, _ = incomplete.partition("=") if incomplete.startswith("-") else ("", "", "")
        try:
            items = super().get_completions(args, incomplete)
        except (UserError, OSError, click.ClickException):
            return []
        words = dict.fromkeys(
            f"{option * bool(equals)}{equals}{item.value}" for item in items if item.type == "plain"
        )
        return [CompletionItem(word) for word in [*words][:MAX_COMPLETIONS]]

    def format_completion(self, item: CompletionItem[str]) -> str:
        """Return the line that is printed for a completion, escaped."""
        return escaped(item.value)


@add_completion_class
class _Bash(_Shell):
    """Bash, which takes the text after ``:`` or ``=`` for a word of its own, unless a quote is open."""

    name = "bash"
    source_template = """_foon_asp() {
    local word
    COMPREPLY=()
    while IFS= read -r word; do
        [[ -n $word ]] && COMPREPLY+=("$word")
    done < <(
        FOON_ASP_LINE="${COMP_LINE:0:COMP_POINT}" %(complete_var)s=bash_complete %(prog_name)s 2>/dev/null
    )
}
complete -o default -o filenames -F _foon_asp %(prog_name)s
"""

    def get_completions(self, args: list[str], incomplete: str) -> list[CompletionItem[str]]:
        """Return the completions of the word ``incomplete``.

        If no quote is open, their text up to the last ``:`` or ``=`` of the word is cut off.
        """
        is_quoted = os.environ[_LINE_VARIABLE].removesuffix(incomplete).endswith(("'", '"'))
        completed = None if is_quoted else re.match(r".*[:=]", incomplete)
        items = super().get_completions(args, incomplete)
        return [CompletionItem(item.value[completed.end() :]) for item in items] if completed else items


@add_completion_class
class _Zsh(_Shell):
    """Zsh, whose script passes the command line up to the cursor."""

    name = "zsh"
    source_template = """#compdef %(prog_name)s
_foon_asp() {
    local -a found
    found=(${(f)"$(FOON_ASP_LINE="$LBUFFER" %(complete_var)s=zsh_complete %(prog_name)s 2>/dev/null)"})
    if (( $#found )); then compadd -a found; else _files; fi
}
compdef _foon_asp %(prog_name)s
"""


@add_completion_class
class _Fish(_Shell):
    """Fish, whose script passes the command line up to the cursor."""

    name = "fish"
    source_template = """function __foon_asp
    FOON_ASP_LINE=(commandline -cp | string collect) %(complete_var)s=fish_complete %(prog_name)s 2>/dev/null
end
complete -c %(prog_name)s -a '(__foon_asp)'
"""


def answer_shell(program: click.Command, request: str) -> ExitCode:
    """Print the script of a shell, or the completions of a command line.

    ``request`` is what click puts into the environment, such as ``bash_source`` or ``bash_complete``.
    """
    return ExitCode(shell_complete(program, {}, "foon-asp", SHELL_REQUEST, request))


@click.command("completion")
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@shared_options.debug_option
@click.pass_context
def command(context: click.Context, shell: str) -> ExitCode:
    """Print a script by which a shell completes verbs, options, goals, objects, motions and constraints.

    \b
    foon-asp completion bash > ~/.local/share/bash-completion/completions/foon-asp
    foon-asp completion fish > ~/.config/fish/completions/foon-asp.fish
    source <(foon-asp completion zsh)            in ~/.zshrc, behind compinit

    Names come from the data that the line names; for a large network, a store (foon-asp merge --store) is
    quicker.
    """
    return answer_shell(context.find_root().command, f"{shell}_source")
