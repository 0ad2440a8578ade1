"""The server answers its own page and nobody else; files outside of its folder stay unseen."""

import http.client
import json
import socket
import struct
import threading
from contextlib import contextmanager, suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from time import monotonic, sleep
from urllib.parse import urlsplit

import numpy as np
import pytest

import trihex as th
from tests.viewer.pages import PATIENCE
from trihex.viewer.bundle import decode, encode
from trihex.viewer.desk import Desk
from trihex.viewer.document import document_of
from trihex.viewer.folder import Folder
from trihex.viewer.server import MAX_BODY, make_viewing

GIGABYTE = 2**30


@pytest.fixture
def viewing(tmp_path):
    folder = tmp_path / "folder"
    folder.mkdir()
    with make_viewing(Desk(Folder(folder))).running() as viewing:
        yield viewing


def request(viewing, method="GET", path="", body=None, **headers):
    """Return (status, headers, body) of a request; a header None is left out."""
    address = urlsplit(viewing.address)
    connection = http.client.HTTPConnection(address.hostname, address.port, timeout=180)
    given = {"Host": address.netloc, **{name.replace("_", "-"): value for name, value in headers.items()}}
    if method == "POST" and "Origin" not in given:
        given["Origin"] = f"http://{address.netloc}"
    connection.putrequest(method, path if path.startswith("/") else address.path + path, skip_host=True)
    for name, value in given.items():
        if value is not None:
            connection.putheader(name, value)
    if body is not None and "Content-Length" not in given:
        connection.putheader("Content-Length", str(len(body)))
    connection.endheaders(body)
    response = connection.getresponse()
    content = response.read()
    connection.close()
    return response.status, response.headers, content


def frames(content):
    """Return the frames of an answer."""
    found = []
    while content:
        length = struct.unpack("<I", content[:4])[0]
        found.append(decode(content[4 : 4 + length]))
        content = content[4 + length :]
    return found


def ask(viewing, header, arrays=None):
    status, _, content = request(viewing, "POST", "ask", encode(header, arrays))
    assert status == 200
    return frames(content)[-1]


def refusal(viewing, header, arrays=None):
    answer = ask(viewing, header, arrays)
    assert answer.header["kind"] == "error"
    return answer.header["message"]


def test_the_page_and_its_module_come_with_headers_of_safety(viewing):
    status, headers, page = request(viewing)
    assert status == 200 and b"<title>trihex</title>" in page
    policy = dict(part.strip().split(" ", 1) for part in headers["Content-Security-Policy"].split(";"))
    assert policy["default-src"] == "'none'" and policy["script-src"] == policy["connect-src"] == "'self'"
    assert policy["frame-ancestors"] == policy["base-uri"] == policy["form-action"] == "'none'"
    assert "unsafe" not in headers["Content-Security-Policy"]
    assert headers["X-Content-Type-Options"] == "nosniff" and headers["Referrer-Policy"] == "no-referrer"
    assert headers["Cross-Origin-Resource-Policy"] == "same-origin" and headers["X-Frame-Options"] == "DENY"
    status, headers, module = request(viewing, path="viewer.js")
    assert status == 200 and headers["Content-Type"].startswith("text/javascript") and b"export class App" in module


def test_it_listens_on_the_loopback_address_only(viewing):
    assert viewing.listener.getsockname()[0] == "127.0.0.1"
    assert len(urlsplit(viewing.address).path) > 20


@pytest.mark.parametrize("path", ["/", "/wrong/", "/wrong/viewer.js", "//", "/%2e%2e/", "/favicon.ico"])
def test_a_wrong_token_is_refused(viewing, path):
    status, _, body = request(viewing, path=path)
    assert status == 403 and b"token" in body


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", "127.0.0.1:1", "localhost.evil.example", "", None])
def test_a_wrong_host_is_refused(viewing, host):
    assert request(viewing, Host=host)[0] in (400, 421)


def test_localhost_is_a_name_of_the_same(viewing):
    assert request(viewing, Host=f"localhost:{urlsplit(viewing.address).port}")[0] == 200


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "https://127.0.0.1:{port}", "http://127.0.0.1", None]
)
def test_a_post_from_another_origin_is_refused(viewing, origin):
    origin = origin and origin.format(port=urlsplit(viewing.address).port)
    status, _, body = request(viewing, "POST", "ask", encode({"op": "files"}), Origin=origin)
    assert status == 403 and b"Origin" in body


def test_what_a_browser_says_comes_from_another_site_is_refused(viewing):
    assert request(viewing, Sec_Fetch_Site="cross-site")[0] == 403
    assert request(viewing, Sec_Fetch_Site="same-site")[0] == 403
    assert request(viewing, Sec_Fetch_Site="none")[0] == 200


@pytest.mark.parametrize("method", ["PUT", "DELETE", "OPTIONS", "TRACE", "PATCH"])
def test_other_methods_are_refused(viewing, method):
    assert request(viewing, method)[0] == 405


def test_a_gigabyte_is_refused_before_it_is_sent(viewing):
    status, _, body = request(viewing, "POST", "ask", b"x" * 1000, Content_Length=str(GIGABYTE))
    assert status == 413 and b"at most" in body
    assert request(viewing, "POST", "ask", b"", Content_Length="9" * 400)[0] in (400, 413)


def test_a_gigabyte_that_does_not_tell_its_size_is_cut_off(viewing):
    address = urlsplit(viewing.address)
    sent, piece = 0, b"100000\r\n" + bytes(2**20) + b"\r\n"
    with socket.create_connection((address.hostname, address.port), timeout=180) as connection:
        head = f"POST {address.path}ask HTTP/1.1\r\nHost: {address.netloc}\r\nOrigin: http://{address.netloc}\r\n"
        connection.sendall(f"{head}Transfer-Encoding: chunked\r\n\r\n".encode())
        with suppress(ConnectionError):
            while sent < GIGABYTE:
                connection.sendall(piece)
                sent += 2**20
    assert sent < 3 * MAX_BODY
    assert request(viewing)[0] == 200  # and it goes on serving


OUTSIDE = ["../secret.map", "a/../../secret.map", "{root}/secret.map", "link.map", "linked/secret.map", "", "a\0b", "."]


@pytest.mark.parametrize("name", OUTSIDE)
def test_no_path_leads_out_of_the_folder(viewing, tmp_path, name):
    secret = tmp_path / "secret.map"
    secret.write_text("type octile\nheight 1\nwidth 1\nmap\n.\n")
    (tmp_path / "folder/link.map").symlink_to(secret)
    (tmp_path / "folder/linked").symlink_to(tmp_path)
    name = name.format(root=tmp_path)
    message = refusal(viewing, {"op": "open", "name": name})
    assert "folder" in message or "file" in message
    document = document_of(th.formats.draft.Draft(th.Area("square", [[0, 0]])))
    wish = {"op": "save", "what": "area", "name": name or "..", "in_folder": True, "overwrite": True}
    refusal(viewing, {**wish, "document": document.header}, document.arrays)
    assert secret.read_text().endswith("map\n.\n")
    assert ask(viewing, {"op": "files"}).header["files"] == []


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.toml", '[area]\npath = "../secret.map"'),
        ("a.toml", '[area]\npath = "{root}/secret.map"'),
        ("a.toml", '[area]\nrows = ["."]\n[robots]\nfile = "../secret.csv"'),
        ("a.yaml", "image: ../secret.pgm\nresolution: 0.1\norigin: [0, 0, 0]"),
        ("a.yaml", "image: '{root}/secret.pgm'\nresolution: 0.1\norigin: [0, 0, 0]"),
        ("b.toml", '[area]\npath = "a.yaml"'),
    ],
)
def test_no_file_names_another_one_outside_of_the_folder(viewing, tmp_path, name, text):
    (tmp_path / "folder/a.yaml").write_text("image: ../secret.pgm\nresolution: 0.1\norigin: [0, 0, 0]")
    (tmp_path / "secret.map").write_text("type octile\nheight 1\nwidth 1\nmap\n.\n")
    (tmp_path / "secret.csv").write_text("x,y\n0,0\n")
    (tmp_path / "secret.pgm").write_bytes(b"P5 1 1 255\n\xff")
    text = text.format(root=tmp_path)
    (tmp_path / "folder" / name).write_text(text)
    assert "folder" in refusal(viewing, {"op": "open", "name": name, "cell_size": 1.0})
    content = np.frombuffer(text.encode(), dtype=np.uint8)
    message = refusal(viewing, {"op": "open", "name": name, "in_folder": False}, {"content": content})
    assert "names another file" in message


def test_files_within_the_folder_may_name_each_other(viewing, tmp_path):
    (tmp_path / "folder/maps").mkdir()
    (tmp_path / "folder/maps/a.map").write_text("type octile\nheight 1\nwidth 3\nmap\n.@.\n")
    (tmp_path / "folder/a.toml").write_text('destinations = [[2, 0]]\n[area]\npath = "maps/a.map"')
    answer = ask(viewing, {"op": "open", "name": "a.toml"})
    assert answer.header["document"]["width"] == 3 and answer.arrays["barriers"].tolist() == [0b01000000]
    assert ask(viewing, {"op": "files"}).header["files"] == ["a.toml", "maps/a.map"]


def test_files_that_name_themselves_and_links_in_a_ring_end_with_a_message(viewing, tmp_path):
    (tmp_path / "folder/ring.map").symlink_to("ring.map")
    assert "ring.map" in refusal(viewing, {"op": "open", "name": "ring.map"})
    (tmp_path / "folder/self.toml").write_text('[area]\npath = "self.toml"')
    assert "must hold an area, not a scenario" in refusal(viewing, {"op": "open", "name": "self.toml"})


def test_a_file_is_not_replaced_unasked(viewing, tmp_path):
    document = document_of(th.formats.draft.Draft(th.Area("square", [[0, 1]])))
    wish = {"op": "save", "what": "area", "name": "a.map", "in_folder": True, "document": document.header}
    assert ask(viewing, wish, document.arrays).header["saved"] == "a.map"
    before = (tmp_path / "folder/a.map").read_text()
    assert before.endswith(".@\n") or ".@" in before or ".T" in before
    assert ask(viewing, wish, document.arrays).header["exists"] is True
    assert ask(viewing, {**wish, "overwrite": True}, document.arrays).header["saved"] == "a.map"


HUGE = {"height": 2**24, "width": 2**24, "tessellation": "square"}
TALL = {"op": "generate", "generator": "maze", "tessellation": "square", "height": 5000, "width": 1, "seed": 1}
NONSENSE = [{}, {"op": "nothing"}, {"op": "plan"}, {"op": "plan", "planner": "greedy", "document": HUGE}, TALL]


@pytest.mark.parametrize(
    "body", [b"", b"nonsense", b"trihex1\n" + b"\xff" * 20, *(encode(header) for header in NONSENSE)]
)
def test_nonsense_is_answered_with_one_line(viewing, body):
    status, _, content = request(viewing, "POST", "ask", body)
    (answer,) = frames(content)
    assert status == 200 and answer.header["kind"] == "error" and "\n" not in answer.header["message"]
    assert "fault" not in answer.header["message"]


def test_work_stops_when_the_page_goes_away(viewing):
    """The automaton on 512 x 512 cells takes minutes; nobody waits for it."""
    document = document_of(th.formats.draft.Draft(th.Area("triangular", np.zeros((512, 512))), np.array([0])))
    body = encode({"op": "generations", "document": document.header}, document.arrays)
    address = urlsplit(viewing.address)
    before = set(threading.enumerate())
    with socket.create_connection((address.hostname, address.port), timeout=180) as connection:
        head = f"POST {address.path}ask HTTP/1.1\r\nHost: {address.netloc}\r\nOrigin: http://{address.netloc}\r\n"
        connection.sendall(f"{head}Content-Length: {len(body)}\r\n\r\n".encode() + body)
        seen = b""
        while b"cells" not in seen:  # the first generations
            seen += connection.recv(2**16)
        assert seen.startswith(b"HTTP/1.1 200") and set(threading.enumerate()) - before
    end = monotonic() + 180
    while (left := set(threading.enumerate()) - before) and monotonic() < end:
        sleep(0.05)
    assert not left


ATTACK = """<!DOCTYPE html><title>attack</title><script>
const address = "ADDRESS", results = {};
async function attempt(name, work) { try { results[name] = await work() } catch (error) { results[name] = "failed" } }
const loaded = (tag, key, src) => new Promise((done) => {
  const element = document.createElement(tag);
  element.onload = () => done("loaded");
  element.onerror = () => done("failed");
  element[key] = src;
  document.body.append(element);
});
(async () => {
  await attempt("read", async () => (await fetch(address)).text());
  await attempt("post", async () => (await fetch(address + "ask", { method: "POST", body: "x" })).text());
  await attempt("blind post", async () =>
    (await fetch(address + "ask", { method: "POST", mode: "no-cors", body: "x" })).type);
  await attempt("script", () => loaded("script", "src", address + "viewer.js"));
  await attempt("frame", async () => {
    const frame = document.createElement("iframe");
    frame.src = address;
    document.body.append(frame);
    await new Promise((done) => (frame.onload = done));
    try { return frame.contentDocument ? "read" : "failed" } catch { return "failed" }
  });
  document.title = JSON.stringify(results);
})();
</script>"""


@contextmanager
def other_site(page):
    class Answer(BaseHTTPRequestHandler):
        def do_GET(self):
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(page.encode())

        def log_message(self, *_):
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Answer)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield f"http://localhost:{server.server_port}/"
    server.shutdown()
    thread.join()
    server.server_close()


def test_a_page_of_another_origin_gets_nothing_even_with_the_token(viewing, browser):
    answered = []
    work = Desk.answer
    Desk.answer = lambda *arguments: answered.append(arguments) or work(*arguments)
    try:
        with other_site(ATTACK.replace("ADDRESS", viewing.address)) as site:
            page = browser.new_page()
            page.set_default_timeout(PATIENCE)
            page.goto(site)
            page.wait_for_function("() => document.title.startsWith('{')")
            results = json.loads(page.title())
            page.close()
    finally:
        Desk.answer = work
    # A blind request is sent, but the server refuses it unread.
    assert results.pop("blind post") in ("opaque", "failed")
    assert set(results.values()) == {"failed"} and len(results) == 4
    assert answered == []
