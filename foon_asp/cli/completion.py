"""``foon-asp completion``: what a shell completes behind ``foon-asp``."""

import re

import click

from foon_asp.cli import options
from foon_asp.cli.completed_words import words_after
from foon_asp.cli.exit_code import ExitCode

# Bash completes what stands behind : and = as a word of its own, and quotes names of files where it has to.
_BASH = """_foon_asp() {
    local word
    COMPREPLY=()
    while IFS= read -r word; do
        COMPREPLY+=("$word")
    done < <(foon-asp completion bash --line "${COMP_LINE:0:COMP_POINT}" 2>/dev/null)
}
complete -o default -o filenames -F _foon_asp foon-asp
"""
_ZSH = """#compdef foon-asp
_foon_asp() {
    local -a found
    found=(${(f)"$(foon-asp completion zsh --line "$LBUFFER" 2>/dev/null)"})
    if (( $#found )); then compadd -a found; else _files; fi
}
compdef _foon_asp foon-asp
"""
_FISH = """function __foon_asp
    foon-asp completion fish --line (commandline -cp | string collect) 2>/dev/null
end
complete -c foon-asp -a '(__foon_asp)'
"""
_SCRIPTS = {"bash": _BASH, "zsh": _ZSH, "fish": _FISH}


@click.command("completion")
@click.argument("shell", type=click.Choice([*_SCRIPTS]))
@click.option(
    "--line", metavar="TEXT", help="What is typed so far: print what it may go on with, as the script asks."
)
@options.debug_option
def command(shell: str, line: str | None) -> ExitCode:
    """Print a script by which a shell completes verbs, options, goals, objects, motions and constraints.

    \b
    foon-asp completion bash > ~/.local/share/bash-completion/completions/foon-asp
    foon-asp completion fish > ~/.config/fish/completions/foon-asp.fish
    source <(foon-asp completion zsh)            in ~/.zshrc, behind compinit

    Names come from the data that the line names; for a large network, a store (foon-asp import) is quicker.
    """
    if line is None:
        click.echo(_SCRIPTS[shell], nl=False)
        return ExitCode.DONE
    found = words_after(line)
    begun = re.match(r".*[:=]", found.fragment) if shell == "bash" and not found.quoted else None
    for word in found.words:
        click.echo(word[begun.end() :] if begun else word)
    return ExitCode.DONE
