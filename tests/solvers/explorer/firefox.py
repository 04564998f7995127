"""Firefox driven by WebDriver BiDi, which it speaks itself: one tab of a browser without a window."""

import json
import os
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from websockets.exceptions import WebSocketException
from websockets.sync.client import ClientConnection, connect

_NUMBERS = '(_, x) => typeof x === "number" && !Number.isFinite(x) ? `number ${x}` : x'  # JSON has none of these
_PREFERENCES = {
    "app.normandy.enabled": False, "app.update.disabledForTesting": True,
    "browser.safebrowsing.downloads.enabled": False,
    "browser.safebrowsing.malware.enabled": False, "datareporting.policy.dataSubmissionEnabled": False,
    "network.captive-portal-service.enabled": False, "network.connectivity-service.enabled": False,
    "remote.active-protocols": 1, "toolkit.telemetry.server": "", "ui.prefersReducedMotion": 1,
}  # fmt: skip


class Tab:
    """What tests of the page use of a tab of Playwright, in Firefox."""

    def __init__(self, connection: ClientConnection) -> None:
        self._connection = connection
        self._count = 0
        self.requests: list[str] = []
        self.complaints: list[str] = []
        self._call("session.new", capabilities={})
        self._call("session.subscribe", events=["network.beforeRequestSent", "log.entryAdded"])
        self._context = self._call("browsingContext.create", type="tab")["context"]

    def _call(self, method: str, **params: Any) -> Any:
        self._count += 1
        self._connection.send(json.dumps({"id": self._count, "method": method, "params": params}))
        while True:
            answer = json.loads(self._connection.recv(timeout=120))
            if answer.get("method") == "network.beforeRequestSent":
                self.requests.append(answer["params"]["request"]["url"])
            elif answer.get("method") == "log.entryAdded":
                self.complaints.append(str(answer["params"].get("text")))
            elif answer.get("id") == self._count:
                assert answer["type"] == "success", answer
                return answer["result"]

    def goto(self, address: str) -> None:
        self._call("browsingContext.navigate", context=self._context, url="about:blank", wait="complete")
        self.requests.clear()
        self.complaints.clear()
        self._call("browsingContext.navigate", context=self._context, url=address, wait="complete")

    def evaluate(self, expression: str, argument: Any = None) -> Any:
        """The value of an expression, or of the function that it gives, of an argument."""
        text = f"(async () => {{ const f = ({expression}); const x = {json.dumps(argument)};"
        text += f' return JSON.stringify(await (typeof f === "function" ? f(x) : f), {_NUMBERS}) }})()'
        found = self._call("script.evaluate", expression=text, target={"context": self._context}, awaitPromise=True)
        assert found["type"] == "success", found
        return _plain(json.loads(found["result"].get("value", "null")))


def _plain(value: Any) -> Any:
    """A value with its numbers that JSON does not have."""
    if isinstance(value, str) and value.startswith("number "):
        return float(value.removeprefix("number "))
    if isinstance(value, list):
        return [_plain(each) for each in value]
    return {key: _plain(each) for key, each in value.items()} if isinstance(value, dict) else value


@contextmanager
def started(executable: str, folder: Path) -> Iterator[Tab]:
    """A tab of a Firefox with a profile of its own in a folder."""
    lines = [f"user_pref({json.dumps(name)}, {json.dumps(value)});" for name, value in _PREFERENCES.items()]
    (folder / "user.js").write_text("\n".join(lines))
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = [executable, "--headless", "--no-remote", "--profile", str(folder), "--remote-debugging-port", str(port)]
    environment = {**os.environ, "HOME": str(folder), "MOZ_CRASHREPORTER_DISABLE": "1"}
    process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        with _connected(port, process) as connection:
            yield Tab(connection)
    finally:
        process.terminate()
        process.wait(30)


def _connected(port: int, process: subprocess.Popen[bytes]) -> ClientConnection:
    for _ in range(300):
        assert process.poll() is None, "Firefox has ended"
        try:
            return connect(f"ws://127.0.0.1:{port}/session", max_size=None, open_timeout=60)
        except (OSError, WebSocketException):
            time.sleep(0.2)
    raise AssertionError("Firefox does not listen")
