"""The page that asks again: who may ask, what is answered, and that nothing else can be read by it."""

import asyncio
import contextlib
import json
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit
from urllib.request import urlopen

import pytest

import foon_asp
from foon_asp import Cancel, UserError
from foon_asp.asp import Settings
from foon_asp.rules.passed_constraint import RuleText
from foon_asp.serve.desk import Desk
from foon_asp.serve.form import Form, RegretForm, read_question
from tests.conftest import Cli
from tests.support.browser import CHROMIUM, browser

starlette = pytest.importorskip("starlette", reason="foon-asp[view] is not installed")

TOKEN, HOST = "secret", "127.0.0.1:80"
OURS = {"host": HOST, "origin": f"http://{HOST}", "content-type": "application/json"}


@pytest.fixture(scope="module")
def desk() -> Desk:
    return Desk(foon_asp.load(), Form(("ice",)))


def request(
    desk: Desk,
    path: str,
    body: object = None,
    headers: dict[str, str] = OURS,
    query: str = "",
    leaves: bool = False,
) -> tuple[int, dict[str, str], str]:
    """Ask the site as a server does."""
    from foon_asp.serve.site import web_application  # noqa: PLC0415 (starlette may be missing)

    sent: list[dict[str, Any]] = []
    coming = [{"type": "http.request", "body": b"" if body is None else json.dumps(body).encode()}]

    async def receive() -> dict[str, Any]:
        if not coming:
            await (asyncio.sleep(0.1) if leaves else asyncio.Event().wait())
            return {"type": "http.disconnect"}
        return coming.pop()

    async def send(message: dict[str, Any]) -> None:
        sent.append(message)

    scope = {
        "type": "http",
        "http_version": "1.1",
        "method": "GET" if body is None else "POST",
        "path": path,
        "raw_path": path.encode(),
        "root_path": "",
        "query_string": query.encode(),
        "headers": [(name.encode(), value.encode()) for name, value in headers.items()],
    }
    asyncio.run(web_application(desk, TOKEN, 80)(scope, receive, send))
    start, *rest = sent
    found = {name.decode(): value.decode() for name, value in start["headers"]}
    return start["status"], found, b"".join(each.get("body", b"") for each in rest).decode()


def told(desk: Desk, path: str, body: object) -> list[dict[str, Any]]:
    status, _, text = request(desk, f"/{TOKEN}/{path}", body)
    assert status == 200
    return [json.loads(line) for line in text.splitlines()]


@pytest.mark.parametrize(
    ("status", "path", "changed"),
    [
        (404, "/", {}),
        (404, "/secretive/ask", {}),
        (404, "/secret/../ask", {}),
        (421, "/secret/ask", {"host": "evil.example"}),
        (403, "/secret/ask", {"origin": "http://evil.example"}),
        (403, "/secret/cancel", {"origin": "null"}),
        (403, "/secret/ask", {"content-type": "text/plain"}),
        (400, "/secret/ask", {}),
    ],
)
def test_who_may_not_ask_is_refused(desk: Desk, status: int, path: str, changed: dict[str, str]) -> None:
    answered, headers, text = request(desk, path, {"goals": "ice"}, OURS | changed)
    assert answered == status
    assert "frame-ancestors 'none'" in headers["content-security-policy"]
    assert (headers["referrer-policy"], headers["cache-control"]) == ("no-referrer", "no-store")
    assert TOKEN not in text


def test_a_question_from_nowhere_is_refused(desk: Desk) -> None:
    without_origin = {name: value for name, value in OURS.items() if name != "origin"}
    assert request(desk, "/secret/cancel", {}, without_origin)[0] == 403
    assert request(desk, "/secret/ask", {"rules": "x" * 1_000_001})[0] == 413


def test_the_page_has_what_can_be_asked_and_may_run_nothing_else(desk: Desk) -> None:
    status, headers, page = request(desk, "/secret/", headers={"host": HOST})
    assert status == 200
    rules = dict(rule.strip().split(" ", 1) for rule in headers["content-security-policy"].split(";"))
    assert rules["connect-src"] == rules["frame-src"] == "'self'"
    assert rules["default-src"] == rules["frame-ancestors"] == rules["form-action"] == "'none'"
    assert re.fullmatch("'sha256-[^']+'", rules["script-src"])
    start = json.loads(page.split('id="data">', 1)[1].split("</script>", 1)[0])
    assert start["first"]["goals"] == ["ice"]
    assert len(start["kitchen"]) == len(foon_asp.load().kitchen)
    assert "muddler; clean" in json.loads(request(desk, "/secret/names", query="start=mud")[2])


def test_an_answer_is_a_page_that_grows(desk: Desk) -> None:
    events = told(desk, "ask", {"goals": ["ice"], "beside": ["searches", "proof"]})
    pages = [event for event in events if event["kind"] == "page"]
    assert len(pages) == 2
    assert events[0] == {"kind": "progress", "text": "found a tree: 2 units, 6 inputs, success 0.644"}
    assert events[-2:] == pages
    assert pages[0]["text"].startswith("optimal by units (strict containers): 2 units")
    status, headers, page = request(desk, f"/secret/page/{pages[-1]['number']}")
    assert (status, headers["content-security-policy"]) == (200, "frame-ancestors 'self'")
    assert "default-src 'none'; script-src 'sha256-" in page
    shown = json.loads(page.split('id="data">', 1)[1].split("</script>", 1)[0])
    answer = foon_asp.solve(foon_asp.load().problem("ice")).json()
    assert [unit["id"] for unit in shown["answer"]["units"]] == [unit["id"] for unit in answer["units"]]
    assert len(shown["searches"]) >= 5
    for number in ("999", "9" * 5_000, "-1", "x", "\u0661", "0x1"):
        assert request(desk, f"/secret/page/{number}")[0] == 404


def test_the_kitchen_the_rules_and_the_objectives_are_asked_with(desk: Desk) -> None:
    foon = foon_asp.load()
    rule = ':- use(U), motion(U,"twist").'
    asked = {
        "goals": ["ice"],
        "objectives": ["success", "inputs"],
        "containers": "implied",
        "without": ["muddler; clean"],
        "rules": rule,
    }
    *_, last = [event for event in told(desk, "ask", asked) if event["kind"] == "page"]
    problem = foon.vary(without="muddler; clean").problem("ice", containers="implied")
    ours = foon_asp.solve(problem, "success,inputs", constraints=rule)
    assert last["text"] == str(ours.text().splitlines()[1])
    page = desk.page(last["number"])
    assert page is not None
    assert '"without_rules": {' in page


def test_rules_and_stocks_of_the_command_line_hold_for_every_question(tmp_path: Path) -> None:
    foon, mine = foon_asp.load(), tmp_path / "mine.lp"
    mine.write_text('#const forbidden="x".\n:- use(U), motion(U,forbidden).\n', encoding="utf-8")
    fixed = (mine, RuleText(":- use(U), #false."))
    glass = foon_asp.parse_node("drinking glass; empty")
    used_up = foon_asp.UsedUp(told={"muddler": False}, stock={glass: 0})
    desk = Desk(foon, Form(), settings=Settings(fixed, constants=('forbidden="crush"',)), used_up=used_up)
    assert desk.opening_data()["always"] == [
        "mine.lp",
        ":- use(U), #false.",
        'forbidden="crush"',
        "stock: drinking glass; empty 0",
        "goes: muddler",
    ]
    (last, *_) = reversed(told(desk, "ask", {"goals": ["ice"], "rules": ":- use(1).", "beside": []}))
    ours = foon_asp.solve(
        foon.problem("ice"), constraints=[mine, ":- use(1)."], constants={"forbidden": '"crush"'}
    )
    assert last["text"] == ours.text().splitlines()[1]
    assert "motion" not in last["text"]
    plan = told(desk, "ask", {"goals": ["ice"], "items": "used-up", "beside": []})[-1]
    assert plan["text"].startswith("infeasible")  # there is no glass


def test_what_is_wrong_with_files_is_said_before_serving(cli: Cli, tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.lp"
    wrong.write_text(":- use(1).\n:- bar(\n", encoding="utf-8")
    ran = cli("view", "--goal", "ice", "--serve", "--constraint", wrong)
    assert (ran.code, "wrong.lp:3:1: error" in ran.err or "wrong.lp:2:" in ran.err) == (2, True)
    ran = cli("view", "--goal", "ice", "--serve", "--stock", wrong)
    assert (ran.code, "add --items used-up" in ran.err) == (2, True)


@pytest.mark.parametrize(
    "asked",
    [
        {"goals": ["ice"], "rules": '#include "/etc/passwd".'},
        {"goals": ["ice"], "rules": "#script (python) print(1) #end."},
        {"goals": ["ice"], "rules": "/etc/passwd"},
        {"goals": ["/etc/passwd"]},
        {"goals": ["ice"], "adding": ["/etc/passwd"]},
        {"goals": ["ice"], "objectives": ["/etc/passwd"]},
        {"goals": []},
    ],
)
def test_no_file_can_be_named(desk: Desk, asked: dict[str, Any]) -> None:
    (error,) = told(desk, "ask", asked)
    assert error["kind"] == "error"
    assert "root:" not in error["text"]


def test_errors_in_rules_have_their_places(desk: Desk) -> None:
    (error,) = told(desk, "ask", {"goals": ["ice"], "rules": ":- use(1).\n:- bar("})
    assert [(each["line"], each["column"]) for each in error["places"]] == [(2, 8)]


@pytest.mark.parametrize(
    "text",
    [
        "",
        '{"goals": "ice"}',
        '{"beside": ["x"]}',
        '{"kitchen": []}',
        '{"goals": ["ice"], "goals": []}',
        '{"page": 1, "unit": 1, "unit": 2}',
        "[" * 9999,
    ],
)
def test_what_is_no_question_is_refused(text: str) -> None:
    with pytest.raises(UserError, match="found"):
        read_question(text.encode(), Form)
    with pytest.raises(UserError):
        read_question(text.encode(), RegretForm)


def test_without_a_unit_or_an_item_it_is_what_regret_says(desk: Desk) -> None:
    *_, page = told(desk, "ask", {"goals": ["ice"]})
    said = set()
    for each in foon_asp.regret(foon_asp.load().problem("ice")).json()["regrets"]:
        what = {"unit": each["unit"]["id"]} if each["unit"] else {"item": each["item"]["node"]}
        (event,) = told(desk, "without", {"page": page["number"], **what})
        best = each["costs"] and f"best is then {each['costs']['units']} unit"
        assert (best or "no tree") in event["text"]
        said.add(each["status"])
    assert said == {"optimal", "infeasible"}
    none = told(desk, "ask", {"goals": ["apple pie"]})[-1]
    for number, said_of in (
        (page["number"], "has nothing of that kind"),
        (none["number"], "not proved best"),
    ):
        (event,) = told(desk, "without", {"page": number, "item": "/etc/passwd"})
        assert (event["kind"], said_of in event["text"]) == ("error", True)


ENDLESS = "p(0). p(X+1) :- p(X), X < 100000000. :- use(U), p(-1)."


@pytest.mark.parametrize("how", ["cancel", "next", "limit"])
def test_a_question_ends_when_it_is_told_to(how: str) -> None:
    desk = Desk(foon_asp.load(), Form(), 0.1 if how == "limit" else None)
    token, events = desk.next_token(), list[dict[str, Any]]()
    form = Form(("ice",), rules=ENDLESS)
    asking = threading.Thread(target=desk.answer_form, args=(form, token, events.append))
    began = time.monotonic()
    asking.start()
    time.sleep(0.1)
    if how == "cancel":
        desk.cancel()
    elif how == "next":
        desk.next_token()
    asking.join(20)
    assert not asking.is_alive()
    assert time.monotonic() - began < 15
    assert ("limit" if how == "limit" else "cancel") in json.dumps(events)


def test_who_leaves_ends_the_question() -> None:
    desk = Desk(foon_asp.load(), Form())
    request(desk, "/secret/ask", {"goals": ["ice"], "rules": ENDLESS}, leaves=True)
    events: list[dict[str, Any]] = []
    asking = threading.Thread(
        target=desk.answer_form, args=(Form(("ice",)), Cancel(), events.append), daemon=True
    )
    asking.start()  # answered when it is its turn, which is when the other has ended
    asking.join(15)
    assert events
    assert events[-1]["kind"] == "page"


def test_a_command_cannot_serve_and_write(cli: Cli, tmp_path: Path) -> None:
    ran = cli("view", "--goal", "ice", "--serve", "-o", tmp_path / "ice.html")
    assert (ran.code, "found -o beside --serve" in ran.err) == (2, True)


@pytest.fixture
def address() -> Iterator[str]:
    command = [sys.executable, "-m", "foon_asp", "view", "--goal", "ice", "--serve", "--time-limit", "60"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        yield process.stdout.readline().strip()
        process.send_signal(signal.SIGINT)
        assert (process.wait(20), process.stderr and process.stderr.read()) == (0, "")


@pytest.mark.parametrize("sent", ["GET / HTTP/1.1\r\n", "POST"])
def test_connections_that_say_too_little_keep_nobody_out(address: str, sent: str) -> None:
    place = urlsplit(address)
    if sent == "POST":
        sent = (
            f"POST {place.path}ask HTTP/1.1\r\nHost: {place.netloc}\r\nOrigin: http://{place.netloc}\r\n"
            'Content-Type: application/json\r\nContent-Length: 99\r\n\r\n{"goals": '
        )
    with contextlib.ExitStack() as stack:
        many = []
        for _ in range(150):
            one = stack.enter_context(socket.create_connection(("127.0.0.1", place.port or 0)))
            one.sendall(sent.encode())
            many.append(one)
        began = time.monotonic()
        with urlopen(address, timeout=20) as page:
            assert page.status == 200
        assert time.monotonic() - began < 10
        many[0].settimeout(20)
        with contextlib.suppress(ConnectionResetError):
            while many[0].recv(1_000):
                pass


@pytest.mark.slow
def test_half_a_request_is_waited_for_ten_seconds(address: str) -> None:
    place = urlsplit(address)
    with socket.create_connection(("127.0.0.1", place.port or 0), timeout=30) as one:
        one.sendall(b"GET / HTTP/1.1\r\n")
        began = time.monotonic()
        with contextlib.suppress(ConnectionResetError):
            assert one.recv(1_000) == b""
        assert 8 < time.monotonic() - began < 25


@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium is installed (apt-get install chromium)")
def test_a_person_asks_again(address: str) -> None:
    with browser() as page:
        page.size(1440, 900)
        page.open(address)

        def until(script: str) -> Any:
            for _ in range(200):
                if found := page.run(script):
                    return found
                time.sleep(0.1)
            raise AssertionError(script)

        frame = "document.querySelector('iframe').contentDocument"
        status = "document.querySelector('[role=status]').textContent"
        done = "document.querySelector('.acts button:last-child').disabled"
        until(f"{done} && {status}.includes('2 units') && {frame}.querySelector('.claim')?.textContent")
        until(f"{frame}.querySelectorAll('[role=tab]').length > 2")

        page.run(f"{frame}.querySelector('.steps button').click()")
        until(
            f"[...{frame}.querySelectorAll('aside p')]"
            ".some(each => /^Without it: (\\+|no tree)/.test(each.textContent))"
        )

        page.run(
            "const field = document.querySelectorAll('input[type=search]')[1]; field.value = 'drinking';"
            "for (const kind of ['input', 'change']) field.dispatchEvent(new Event(kind))"
        )
        lines = "[...document.querySelectorAll('.many label')]"
        assert page.run(f"{lines}.filter(each => !each.hidden).map(each => each.textContent)") == [
            "drinking glass; empty"
        ]
        page.run(
            "[...document.querySelectorAll('.many input')]"
            ".find(each => each.value === 'drinking glass; empty').click()"
        )
        page.run("document.querySelector('.acts .main').click()")
        until(f"{done} && {status}.includes('no task tree exists')")
        until(f"{frame}.querySelector('.claim')?.textContent.includes('No tree exists')")

        assert page.complaints == []
        assert all(each.startswith(address) for each in page.requests)
