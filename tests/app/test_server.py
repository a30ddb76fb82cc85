#!/usr/bin/env python3
"""Who gets what from `hexhex view --serve`: this machine alone, under its own name, with the secret, and
soon.

    test_server.py PATH-OF-HEXHEX [unittest options]

Needs nothing but Python's standard library, and skips (exit code 77) what was built without the viewer.
"""

import base64
import hashlib
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

SUCCESS, BAD_USAGE = 0, 2
CORNERS = ["0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "1 1 1", "0 1 1"]
CUBE = "\n".join(["MeshVersionFormatted 2", "Dimension 3", "Vertices", "8", *(c + " 0" for c in CORNERS),
                  "Hexahedra", "1", "1 2 3 4 5 6 7 8 0", "End", ""])
# How long anything may take that shall happen at once; nothing is measured.
PATIENCE = 60


class ServerTest(unittest.TestCase):
    command = ""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "cube.mesh").write_text(CUBE)
        self.start("cube.mesh")

    def start(self, mesh, *options):
        self.process = subprocess.Popen(
            [self.command, "view", mesh, "--serve", "--quiet", *options], cwd=self.folder,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.end)
        self.address = self.process.stdout.readline().strip()
        if not self.address:
            self.fail(self.process.communicate(timeout=PATIENCE)[1])
        found = re.fullmatch(r"http://127\.0\.0\.1:(\d+)(/[0-9a-f]{32}/)", self.address)
        self.assertTrue(found, self.address)
        self.port, self.path = int(found[1]), found[2]

    def end(self, with_signal=signal.SIGINT):
        """Tells the server to end; returns its exit code and what it said."""
        if self.process.returncode is None:
            self.process.send_signal(with_signal)
            _, self.errors = self.process.communicate(timeout=PATIENCE)
        return self.process.returncode, self.errors

    def connect(self):
        connection = socket.create_connection(("127.0.0.1", self.port), timeout=PATIENCE)
        self.addCleanup(connection.close)
        return connection

    @staticmethod
    def rest_of(connection):
        """All that comes until the server closes the connection."""
        received = b""
        try:
            while more := connection.recv(65536):
                received += more
        except ConnectionResetError:
            pass
        return received

    def answer(self, request):
        """Status, headers, body."""
        connection = self.connect()
        connection.sendall(request if isinstance(request, bytes) else request.encode())
        head, _, body = self.rest_of(connection).partition(b"\r\n\r\n")
        status, *lines = head.decode().split("\r\n")
        return status[len("HTTP/1.1 "):], dict(line.split(": ", 1) for line in lines), body

    def ask(self, method="GET", path=None, host=None, version="1.1", more=""):
        host = f"127.0.0.1:{self.port}" if host is None else host
        return self.answer(f"{method} {self.path if path is None else path} HTTP/{version}\r\n"
                           f"Host: {host}\r\n{more}\r\n")

    def descriptors(self):
        return len(os.listdir(f"/proc/{self.process.pid}/fd"))

    def test_serves_page_and_mesh(self):
        for host in [f"127.0.0.1:{self.port}", f"localhost:{self.port}"]:
            for version in ["1.0", "1.1"]:
                status, headers, body = self.ask(host=host, version=version)
                self.assertEqual(status, "200 OK")
                self.assertEqual(int(headers["Content-Length"]), len(body))
                self.assertIn(b"mesh-info", body)
        for name, value in {"Cache-Control": "no-store", "X-Content-Type-Options": "nosniff",
                            "Referrer-Policy": "no-referrer", "Connection": "close",
                            "Cross-Origin-Resource-Policy": "same-origin",
                            "Content-Security-Policy": "frame-ancestors 'none'"}.items():
            self.assertEqual(headers[name], value)
        self.assertNotIn("Access-Control-Allow-Origin", headers)
        status, headers, body = self.ask(path=self.path + "mesh")
        self.assertEqual((status, headers["Content-Type"]), ("200 OK", "application/octet-stream"))
        self.assertEqual(int(headers["Content-Length"]), len(body))
        status, headers, nothing = self.ask(method="HEAD", path=self.path + "mesh")
        self.assertEqual((status, int(headers["Content-Length"]), nothing), ("200 OK", len(body), b""))

    def test_page_allows_nothing_from_outside(self):
        page = self.ask()[2].decode()
        policy = re.search(r'<meta http-equiv="Content-Security-Policy" content="([^"]*)">', page)[1]
        said = dict(part.split(" ", 1) for part in policy.split("; "))

        def hash_of(tag):
            (text,) = re.findall(rf"<{tag}>(.*?)</{tag}>", page, re.S)
            return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"

        self.assertEqual(said, {
            "default-src": "'none'", "script-src": hash_of("script"), "style-src": hash_of("style"),
            "worker-src": "blob:", "img-src": "data:", "connect-src": "'self'", "base-uri": "'none'",
            "form-action": "'none'"})
        # Before anything that it is about.
        self.assertLess(page.index("Content-Security-Policy"), page.index("<title>"))

    def test_each_address_is_new(self):
        first = self.path
        self.end()
        self.start("cube.mesh")
        self.assertNotEqual(self.path, first)

    def test_listens_on_loopback_only(self):
        with self.assertRaises(OSError):
            socket.create_connection(("127.0.0.2", self.port), timeout=2).close()
        port = f"{self.port:04X}"
        tables = [pathlib.Path("/proc/net/tcp"), pathlib.Path("/proc/net/tcp6")]
        listening = [fields[1] for table in tables if table.exists()
                     for fields in map(str.split, table.read_text().split("\n")[1:-1])
                     if fields[3] == "0A" and fields[1].endswith(f":{port}")]
        self.assertEqual(listening, [f"0100007F:{port}"])

    def test_refuses_other_hosts(self):
        # A name that somebody else's page has turned to this address.
        for host in ["example.org", f"example.org:{self.port}", "127.0.0.1", "localhost", "",
                     f"127.0.0.1:{self.port}.example.org", f"x@127.0.0.1:{self.port}",
                     f"127.0.0.1:{self.port + 1}", f"[::1]:{self.port}", "127.0.0.1:80",
                     f"127.0.0.1:{self.port}, example.org"]:
            status, _, body = self.ask(host=host)
            self.assertEqual((status, body), ("403 Forbidden", b"403 Forbidden\n"), host)
        name = f"127.0.0.1:{self.port}"
        for lines in ["", f"Host: {name}\r\nHost: {name}\r\n", f"X-Host: {name}\r\n",
                      f"Host: {name}\r\nhOsT: example.org\r\n"]:
            self.assertEqual(self.answer(f"GET {self.path} HTTP/1.1\r\n{lines}\r\n")[0],
                             "403 Forbidden", lines)
        # ... even who knows the secret gets no more under another name.
        self.assertEqual(self.ask(path=self.path + "mesh", host="example.org")[0], "403 Forbidden")

    def test_refuses_other_paths(self):
        wrong = self.path.translate(str.maketrans("0123456789abcdef", "123456789abcdef0"))
        for path in ["/", "/mesh", self.path[:-1], self.path[:-2] + "/", wrong, wrong + "mesh",
                     self.path.upper() + "?", self.path + "mesh/", self.path + "/mesh",
                     self.path + "../cube.mesh", self.path + "cube.mesh", self.path + "%6desh",
                     "/.." + self.path, "//etc/passwd", "/../../../../etc/passwd",
                     "/%2e%2e/%2e%2e/etc/passwd", self.path + "?a=b", self.path + "#x", "*",
                     f"http://127.0.0.1:{self.port}{self.path}", "/favicon.ico", self.path + "\x00"]:
            self.assertEqual(self.ask(path=path)[0], "404 Not Found", path)

    def test_refuses_other_methods(self):
        for method in ["POST", "PUT", "DELETE", "OPTIONS", "TRACE", "CONNECT", "PATCH", "get", "PRI"]:
            status, headers, body = self.ask(method=method, more="Content-Length: 3\r\n")
            self.assertEqual((status, headers["Allow"]), ("405 Method Not Allowed", "GET, HEAD"))
            self.assertNotIn(b"mesh-info", body)

    def test_refuses_what_is_no_request(self):
        for request in [b"\r\n\r\n", b"GET\r\n\r\n", b"GET / HTTP/2.0\r\n\r\n", b"GET /\r\n\r\n",
                        b"\x16\x03\x01\x02\x00\x01\x00\r\n\r\n", b"\x00" * 99 + b"\r\n\r\n",
                        b"GET / HTTP/1.1\r\nno colon\r\n\r\n", b"GET  / HTTP/1.1\r\n\r\n"]:
            self.assertEqual(self.answer(request)[0], "400 Bad Request", request)
        for long in [b"GET /" + b"a" * 9000, b"GET / HTTP/1.1\r\n" + b"A: b\r\n" * 2000]:
            self.assertEqual(self.answer(long)[0], "431 Request Header Fields Too Large")
        self.assertEqual(self.ask()[0], "200 OK")

    def test_answers_what_comes_in_pieces(self):
        connection = self.connect()
        for byte in f"GET {self.path}mesh HTTP/1.1\r\nhost:127.0.0.1:{self.port} \r\n\r\n".encode():
            connection.sendall(bytes([byte]))
        self.assertTrue(self.rest_of(connection).startswith(b"HTTP/1.1 200 OK\r\n"))

    def test_lets_slow_clients_down(self):
        """Who says nothing, or a byte now and then."""
        silent = self.connect()
        dripping = self.connect()
        ended = threading.Event()

        def drip():
            try:
                while not ended.wait(0.2):
                    dripping.sendall(b"G")
            except OSError:
                pass

        thread = threading.Thread(target=drip)
        thread.start()
        try:
            self.assertEqual(self.rest_of(silent), b"")
            self.assertEqual(self.rest_of(dripping), b"")
        finally:
            ended.set()
            thread.join()
        self.assertEqual(self.ask()[0], "200 OK")

    def test_lets_down_who_does_not_read(self):
        self.end()
        for arguments in ["generate sphere --cells 12 --refine 6 --jitter 0.05 -o map.hexex",
                          "extract map.hexex --scale 5 --no-verify -o large.vtu"]:
            subprocess.run([self.command, *arguments.split(), "--quiet"], cwd=self.folder, check=True)
        self.start("large.vtu")
        idle = self.descriptors()
        size = int(self.ask(method="HEAD", path=self.path + "mesh")[1]["Content-Length"])
        self.assertGreater(size, 9e6)  # more than the system takes for the client
        reader = socket.socket()
        self.addCleanup(reader.close)
        reader.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        reader.settimeout(PATIENCE)
        reader.connect(("127.0.0.1", self.port))
        reader.sendall(f"GET {self.path}mesh HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\n\r\n".encode())
        end = time.monotonic() + PATIENCE
        while self.descriptors() > idle and time.monotonic() < end:
            time.sleep(0.2)
        self.assertEqual(self.descriptors(), idle)
        self.assertLess(len(self.rest_of(reader)), size)
        # Who does read gets all of it.
        self.assertEqual(len(self.ask(path=self.path + "mesh")[2]), size)

    def test_many_connections_keep_nobody_out(self):
        idle = [self.connect() for _ in range(200)]
        for _ in range(5):
            self.assertEqual(self.ask()[0], "200 OK")
        for connection in idle[:100]:
            self.assertEqual(self.rest_of(connection), b"")  # to make room
        self.assertLess(self.descriptors(), 60)

    def test_lives_on_when_clients_leave(self):
        for request in [b"", b"GET", f"GET {self.path} HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\n\r\n".encode()]:
            for _ in range(10):
                connection = self.connect()
                connection.sendall(request)
                # Without a farewell: what is sent next meets a closed connection.
                connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
                connection.close()
        self.assertEqual(self.ask()[0], "200 OK")

    def test_has_few_descriptors(self):
        self.end()
        self.process = subprocess.Popen(
            ["sh", "-c", 'ulimit -n 12; exec "$0" view cube.mesh --serve --quiet', self.command],
            cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        self.port = int(self.address.split(":")[2].split("/")[0])
        self.path = "/" + self.address.split("/", 3)[3]
        for _ in range(40):
            self.connect()
        self.assertEqual(self.ask()[0], "200 OK")

    def test_ends_when_told(self):
        for number in [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]:
            if self.process.returncode is not None:
                self.start("cube.mesh")
            idle = self.connect()
            reading = self.connect()  # and does not read
            reading.sendall(f"GET {self.path} HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\n\r\n".encode())
            self.assertEqual(self.end(number), (SUCCESS, ""))
            self.assertEqual(self.rest_of(idle), b"")
            with self.assertRaises(OSError):
                socket.create_connection(("127.0.0.1", self.port), timeout=2).close()
        self.assertEqual([path.name for path in self.folder.iterdir()], ["cube.mesh"])

    def test_takes_the_port_that_was_asked_for(self):
        run = subprocess.run([self.command, "view", "cube.mesh", "--serve", "--port", str(self.port)],
                             cwd=self.folder, text=True, capture_output=True, timeout=PATIENCE, check=False)
        self.assertEqual(run.returncode, BAD_USAGE)
        self.assertIn("cannot be used", run.stderr)
        port = self.port
        self.ask()  # so that a connection has been there
        self.end()
        self.start("cube.mesh", "--port", str(port))
        self.assertEqual(self.port, port)

    def test_names_are_text(self):
        name = "\"'<img src=x onerror=alert(1)>&lt;<script>-->.mesh"
        (self.folder / name).write_text(CUBE)
        self.end()
        self.start(name)
        page = self.ask()[2].decode()
        self.assertNotIn("<img", page)
        self.assertIn("&lt;img src=x onerror=alert(1)>&amp;lt;&lt;script>", page)
        self.assertEqual(page.count("<script>"), 1)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    ServerTest.command = os.path.abspath(sys.argv.pop(1))
    if "without the viewer" in subprocess.run([ServerTest.command, "view", "none.mesh"], text=True,
                                              capture_output=True, check=False).stderr:
        sys.exit(77)
    unittest.main()
