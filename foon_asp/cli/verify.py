"""``foon-asp verify``: is a certificate right? Without any solver."""

import json
from pathlib import Path

import click

from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.errors import UserError
from foon_asp.proof.verify import RefusedError, load_certificate, verify
from foon_asp.report.certified import verified_json, verified_text


@click.command("verify")
@click.argument("certificate", type=click.Path(path_type=NamedPath), metavar="CERTIFICATE")
@options.format_option("text", "json")
@options.data_options
def command(certificate: Path, format_: str, **data: object) -> ExitCode:
    """Check a certificate against the data it speaks about, and say what it proves.

    \b
    foon-asp solve --goal 'greek salad' --certificate proof.json
    foon-asp verify proof.json

    The data has to be the same: --data and the other options name it as they do for solve. Exits with 0 when
    the certificate is right and with 1 when it is refused.
    """
    try:
        content = load_certificate(certificate)
    except (OSError, UnicodeDecodeError) as error:
        raise UserError(f"{certificate}: cannot be read: {error}") from None
    except RefusedError as refused:
        return _refused(refused, format_)
    dataset = options.read_dataset(**data)  # type: ignore[arg-type]
    read = dataset.data
    try:
        verified = verify(content, read.network, read.kitchen, read.rates, read.utensils)
    except RefusedError as refused:
        return _refused(refused, format_)
    if format_ == "json":
        click.echo(json.dumps(verified_json(verified, read.network), indent=2, ensure_ascii=False))
    else:
        click.echo(verified_text(verified, read.network, content), nl=False)
    return ExitCode.DONE


def _refused(refused: RefusedError, format_: str) -> ExitCode:
    if format_ == "json":
        click.echo(json.dumps({"verified": False, "reason": str(refused)}, indent=2, ensure_ascii=False))
    else:
        click.echo(f"refused: {refused}")
    return ExitCode.NEGATIVE
