#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""`vsplit serve`: ranges, CORS, paths that lead out, clients that are slow or hostile, and its end."""
import http.client
import json
import os
import re
import signal
import socket
import subprocess
import threading
import time
import unittest

import harness
from harness import BAD_INPUT, USAGE, CommandTest, main

DATA = bytes(range(256)) * 1024


class Server:
    def __init__(self, test, *args, folder='public'):
        self.process = subprocess.Popen([harness.VSPLIT, 'serve', folder, '--port', '0', '--json', *args], cwd=test.folder,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        text = ''
        while not text.rstrip().endswith('}'):
            line = self.process.stdout.readline().decode()
            if not line:
                raise AssertionError(f'the server did not start: {self.process.stderr.read().decode()}')
            text += line
        self.said = json.loads(text)
        self.port = self.said['port']
        test.addCleanup(self.kill)

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.process.stdout.close()
        self.process.stderr.close()

    def ask(self, path, method='GET', **headers):
        connection = http.client.HTTPConnection('127.0.0.1', self.port, timeout=20)
        connection.putrequest(method, path, skip_host='Host' in headers, skip_accept_encoding=True)
        for name, value in headers.items():
            connection.putheader(name.replace('_', '-'), value)
        connection.endheaders()
        response = connection.getresponse()
        body = response.read()
        connection.close()
        return response, body

    def connect(self):
        return socket.create_connection(('127.0.0.1', self.port), timeout=30)

    def raw(self, data):
        """What comes back for these bytes, up to the end of the connection."""
        with self.connect() as s:
            s.sendall(data)
            received = b''
            try:
                while more := s.recv(65536):
                    received += more
            except ConnectionError:
                pass
            return received


class ServeTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.path('public/deep/er').mkdir(parents=True)
        self.path('secret').mkdir()
        self.write('public/data.pmesh', DATA)
        self.write('public/empty.bin', b'')
        self.write('public/scene.glb', b'glTF')
        self.write('public/module.wasm', b'\0asm')
        self.write('public/.hidden', b'key')
        self.write('public/deep/er/a & b %41<i>.txt', b'text')
        self.write('secret/key', b'PRIVATE')
        self.write('key', b'PRIVATE')

    def serve(self, *args, **more):
        return Server(self, *args, **more)

    def test_whole_files(self):
        server = self.serve()
        for path, kind, data in (('/data.pmesh', 'application/vnd.vsplit.pmesh', DATA), ('/scene.glb', 'model/gltf-binary', b'glTF'),
                                 ('/module.wasm', 'application/wasm', b'\0asm'), ('/empty.bin', 'application/octet-stream', b''),
                                 ('/deep/er/a%20%26%20b%20%2541%3Ci%3E.txt', 'text/plain; charset=utf-8', b'text')):
            with self.subTest(path):
                response, body = server.ask(path, Accept_Encoding='gzip, br')
                self.assertEqual((response.status, body), (200, data))
                self.assertEqual(response.headers['Content-Type'], kind)
                self.assertEqual(response.headers['Content-Length'], str(len(data)))
                self.assertEqual(response.headers['Accept-Ranges'], 'bytes')
                self.assertNotIn('Content-Encoding', response.headers)
                self.assertIn('no-transform', response.headers['Cache-Control'])
                head, nothing = server.ask(path, 'HEAD')
                self.assertEqual((head.status, nothing, head.headers['Content-Length']), (200, b'', str(len(data))))

    def test_ranges(self):
        server = self.serve()
        size = len(DATA)
        for asked, first, last in (('0-0', 0, 0), ('10-19', 10, 19), ('100-', 100, size - 1), ('-7', size - 7, size - 1), ('-999999999', 0, size - 1),
                                   (f'{size - 1}-', size - 1, size - 1), (f'5-{size * 9}', 5, size - 1), ('5-99999999999999999999999', 5, size - 1), (' 3-4 ', 3, 4)):
            with self.subTest(asked):
                response, body = server.ask('/data.pmesh', Range=f'bytes={asked}')
                self.assertEqual(response.status, 206)
                self.assertEqual(response.headers['Content-Range'], f'bytes {first}-{last}/{size}')
                self.assertEqual(body, DATA[first:last + 1])
        for asked in (f'{size}-', f'{size}-{size + 5}', '-0', '99999999999999999999999-'):
            with self.subTest(asked):
                response, body = server.ask('/data.pmesh', Range=f'bytes={asked}')
                self.assertEqual((response.status, response.headers['Content-Range']), (416, f'bytes */{size}'))
                self.assertEqual(response.headers['Access-Control-Allow-Origin'], '*')
        self.assertEqual(server.ask('/empty.bin', Range='bytes=0-5')[0].status, 416)
        # What is no range of bytes is ignored, and so is what would make the server work for nothing.
        for asked in ('items=0-5', 'bytes=', 'bytes=x-y', 'bytes=9-3', 'bytes=0-5,9-3', 'bytes=--5', 'bytes=5', 'bytes=0-9,5-14', 'bytes=' + ','.join(['0-'] * 300),
                      'bytes=' + ','.join(f'{2 * i}-{2 * i}' for i in range(17)), 'bytes=0-1;2-3', 'bytes=+1-2', 'bytes=0x1-2'):
            with self.subTest(asked[:40]):
                response, body = server.ask('/data.pmesh', Range=asked)
                self.assertEqual((response.status, body), (200, DATA))
                self.assertNotIn('Content-Range', response.headers)
        head, _ = server.ask('/data.pmesh', 'HEAD', Range='bytes=0-9')
        self.assertEqual((head.status, head.headers['Content-Length']), (206, '10'))

    def test_several_ranges(self):
        response, body = self.serve().ask('/data.pmesh', Range='bytes=0-2, 1000-1003,-2')
        self.assertEqual((response.status, response.headers['Content-Length']), (206, str(len(body))))
        boundary = re.fullmatch(r'multipart/byteranges; boundary=([\w-]+)', response.headers['Content-Type']).group(1).encode()
        parts = body.split(b'\r\n--' + boundary)
        self.assertEqual((parts[0], parts[-1], len(parts)), (b'', b'--\r\n', 5))
        for part, (first, last) in zip(parts[1:-1], ((0, 2), (1000, 1003), (len(DATA) - 2, len(DATA) - 1))):
            head, data = part.split(b'\r\n\r\n', 1)
            self.assertIn(f'Content-Range: bytes {first}-{last}/{len(DATA)}'.encode(), head)
            self.assertEqual(data, DATA[first:last + 1])

    def test_conditions(self):
        server = self.serve()
        first, _ = server.ask('/data.pmesh')
        tag, date = first.headers['ETag'], first.headers['Last-Modified']
        for headers in ({'If_None_Match': tag}, {'If_None_Match': f'"x", W/{tag}'}, {'If_None_Match': '*'}, {'If_Modified_Since': date}):
            response, body = server.ask('/data.pmesh', **headers)
            self.assertEqual((response.status, body, response.headers['ETag']), (304, b'', tag))
        self.assertEqual(server.ask('/data.pmesh', If_None_Match='"x"', If_Modified_Since=date)[0].status, 200)
        for same in (tag, date):
            self.assertEqual(server.ask('/data.pmesh', Range='bytes=0-9', If_Range=same)[0].status, 206)
        for other in ('"x"', 'W/' + tag, 'Mon, 01 Jan 2001 00:00:00 GMT'):
            response, body = server.ask('/data.pmesh', Range='bytes=0-9', If_Range=other)
            self.assertEqual((response.status, body), (200, DATA))
        # Another file under the same name has another tag, though it has the same length.
        self.write('new', DATA[::-1])
        os.replace(self.path('new'), self.path('public/data.pmesh'))
        response, body = server.ask('/data.pmesh', Range='bytes=0-9', If_Range=tag)
        self.assertEqual((response.status, body), (200, DATA[::-1]))

    def test_other_origins(self):
        server = self.serve()
        response, _ = server.ask('/data.pmesh', 'OPTIONS', Origin='http://elsewhere', Access_Control_Request_Method='GET', Access_Control_Request_Headers='range')
        self.assertEqual(response.status, 204)
        self.assertEqual(response.headers['Access-Control-Allow-Origin'], '*')
        self.assertIn('Range', response.headers['Access-Control-Allow-Headers'])
        self.assertIn('GET', response.headers['Access-Control-Allow-Methods'])
        for path in ('/data.pmesh', '/missing', '/'):
            response, _ = server.ask(path, Origin='http://elsewhere')
            self.assertEqual(response.headers['Access-Control-Allow-Origin'], '*')
            for name in ('Content-Range', 'Content-Length', 'ETag', 'Accept-Ranges'):
                self.assertIn(name, response.headers['Access-Control-Expose-Headers'])
        response, _ = self.serve('--cors', 'none').ask('/data.pmesh', Origin='http://elsewhere')
        self.assertNotIn('Access-Control-Allow-Origin', response.headers)
        response, _ = self.serve('--cors', 'https://mine').ask('/data.pmesh')
        self.assertEqual((response.headers['Access-Control-Allow-Origin'], response.headers['Vary']), ('https://mine', 'Origin'))

    def test_nothing_outside(self):
        os.symlink('../secret/key', self.path('public/link'))
        os.symlink('../secret', self.path('public/door'))
        os.symlink('/', self.path('public/root'))
        os.symlink('data.pmesh', self.path('public/inner'))
        os.mkfifo(self.path('public/pipe'))
        server = self.serve()
        out = self.path('key')
        for path in ('/../key', '/../secret/key', '/deep/../../key', '/%2e%2e/key', '/%2E%2E%2Fkey', '/..%2fkey', '/deep/%2e%2e/%2e%2e/key', '/%252e%252e/key', '/..%5ckey', '/.%2e/key',
                     '/link', '/door/key', '/door', '/root/etc/passwd', '/inner', '/pipe', '/.hidden', '/deep/.', '//key', '/deep//er/', f'/{out}', f'/{out}'.replace('//', '/%2f'),
                     '/data.pmesh/', '/data.pmesh%00.txt', '/deep/er%00', '/%', '/%zz', '/_vsplit/../data.pmesh', '/_vsplit/%2e%2e/data.pmesh', '/_vsplit/nothing'):
            with self.subTest(path):
                response, body = server.ask(path)
                self.assertEqual(response.status, 404, body)
                self.assertNotIn(b'PRIVATE', body)
        for line in (b'GET ../key HTTP/1.1', b'GET key HTTP/1.1', b'GET http://127.0.0.1/../key HTTP/1.1', b'GET /../key HTTP/1.0'):
            with self.subTest(line):
                received = server.raw(line + b'\r\nConnection: close\r\n\r\n')
                self.assertRegex(received, rb'^HTTP/1.1 4\d\d ')
                self.assertNotIn(b'PRIVATE', received)

    def test_folders_and_listing(self):
        self.baked('public/whale.pmesh')
        self.write('public/deep/plain.glb', b'glTF')
        server = self.serve()
        response, body = server.ask('/deep')
        self.assertEqual((response.status, response.headers['Location']), (301, '/deep/'))
        response, body = server.ask('/')
        text = body.decode()
        self.assertEqual((response.status, response.headers['Content-Type']), (200, 'text/html; charset=utf-8'))
        self.assertIn('whale.pmesh', text)
        self.assertRegex(text, r'1,\d\d\d triangles')
        self.assertIn('href="/deep/"', text)
        self.assertNotIn('.hidden', text)
        self.assertIn("default-src 'self'", response.headers['Content-Security-Policy'])
        text = server.ask('/deep/er/')[1].decode()
        self.assertIn('a &amp; b %41&lt;i&gt;.txt', text)
        self.assertIn('/deep/er/a%20%26%20b%20%2541%3Ci%3E.txt', text)
        self.assertNotIn('<i>', text)
        self.write('public/deep/index.html', b'mine')
        self.assertEqual(server.ask('/deep/')[1], b'mine')

    def test_methods_and_bodies(self):
        server = self.serve()
        for method in ('POST', 'PUT', 'DELETE', 'PATCH'):
            response, _ = server.ask('/data.pmesh', method, Content_Length='0')
            self.assertEqual((response.status, response.headers['Allow']), (405, 'GET, HEAD, OPTIONS'))
        # A body is not taken for another request.
        inner = b'GET /data.pmesh HTTP/1.1\r\n\r\n'
        for head in (b'POST /', b'GET /empty.bin'):
            received = server.raw(head + b' HTTP/1.1\r\nContent-Length: %d\r\n\r\n' % len(inner) + inner)
            self.assertEqual(received.count(b'HTTP/1.1 '), 1, received[:500])
        self.assertEqual(self.path('public/data.pmesh').read_bytes(), DATA)

    def test_limits_of_requests(self):
        server = self.serve()
        for request, status in ((b'GET /' + b'a' * 9000 + b' HTTP/1.1\r\n\r\n', 414), (b'GET / HTTP/1.1\r\n' + b'X: ' + b'a' * 7000 + b'\r\nY: ' + b'a' * 7000 + b'\r\nZ: ' + b'a' * 7000 + b'\r\n\r\n', 431),
                                (b'GET / HTTP/1.1\r\n' + b'A: b\r\n' * 100000, 431), (b'nonsense\r\n\r\n', 400), (b'\0\1\2\r\n\r\n', 400), (b'GET / HTTP/9\r\n\r\n', 400)):
            with self.subTest(request[:20]):
                received = server.raw(request)
                if received:  # the connection may be reset while we still send
                    self.assertEqual(int(received.split()[1]), status, received[:200])
        self.assertEqual(server.raw(b'A' * 100000)[:0], b'')
        self.assertEqual(server.ask('/data.pmesh')[0].status, 200)

    def test_keep_alive_and_pipelining(self):
        server = self.serve()
        connection = http.client.HTTPConnection('127.0.0.1', server.port, timeout=20)
        for first in range(0, 2000, 100):
            connection.request('GET', '/data.pmesh', headers={'Range': f'bytes={first}-{first + 99}'})
            self.assertEqual(connection.getresponse().read(), DATA[first:first + 100])
        connection.close()
        received = server.raw(b'GET /scene.glb HTTP/1.1\r\n\r\n' * 2 + b'GET /scene.glb HTTP/1.1\r\nConnection: close\r\n\r\n')
        self.assertEqual(received.count(b'glTF'), 3)

    def test_slow_clients_do_not_stop_others(self):
        server = self.serve()
        slow = [server.connect() for _ in range(40)]
        for i, s in enumerate(slow):
            s.sendall(b'GET /data.pmesh HTTP/1.1\r\n' + (b'X-Slow: ' if i % 2 else b'\r\n'))
        began = time.monotonic()
        threads = [threading.Thread(target=lambda: self.assertEqual(server.ask('/data.pmesh')[1], DATA)) for _ in range(8)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        self.assertLess(time.monotonic() - began, 9)
        for s in slow:
            s.close()

    def test_a_crowd_of_slow_clients_is_shown_out(self):
        self.write('public/big.bin', bytes(20_000_000))
        server = self.serve()
        # More than it serves at once: some say nothing, some a byte of a header now and then, some hardly read.
        crowd = [server.connect() for _ in range(600)]
        for i, s in enumerate(crowd):
            s.setblocking(False)
            if i % 3:
                s.send(b'GET / HTTP/1.1\r\nX: ' if i % 3 == 1 else b'GET /big.bin HTTP/1.1\r\n\r\n')
        over = threading.Event()

        def drip():
            while not over.wait(0.1):
                for i, s in enumerate(crowd):
                    try:
                        s.recv(8) if i % 3 == 2 else s.send(b'a') if i % 3 == 1 else None
                    except OSError:
                        pass
        dripping = threading.Thread(target=drip)
        dripping.start()
        try:
            began = time.monotonic()
            self.assertEqual(server.ask('/data.pmesh')[1], DATA)
            self.assertLess(time.monotonic() - began, 15)
        finally:
            over.set()
            dripping.join()
            for s in crowd:
                s.close()
        self.assertEqual(server.ask('/data.pmesh')[0].status, 200)

    def test_a_file_that_shrinks(self):
        big = self.path('public/big.bin')
        big.write_bytes(bytes(50_000_000))
        server = self.serve()
        with server.connect() as s:
            s.sendall(b'GET /big.bin HTTP/1.1\r\n\r\n')
            s.recv(1000)
            os.truncate(big, 1000)
            received = 1000
            while more := s.recv(1 << 20):
                received += len(more)
        self.assertLess(received, 50_000_000)
        self.assertEqual(server.ask('/data.pmesh')[0].status, 200)

    def test_ends_gently(self):
        self.write('public/big.bin', bytes(8_000_000))
        for how in (signal.SIGINT, signal.SIGTERM):
            server = self.serve()
            idle = server.connect()
            with server.connect() as s:
                s.sendall(b'GET /big.bin HTTP/1.1\r\n\r\n')
                received = s.recv(1000)
                server.process.send_signal(how)
                time.sleep(0.3)
                while more := s.recv(1 << 20):
                    received += more
            self.assertGreater(len(received), 8_000_000, 'a response on its way comes to its end')
            self.assertEqual(server.process.wait(timeout=10), 0)
            idle.close()
            with self.assertRaises(OSError):
                server.connect()
        # Told twice, it does not wait for those who do not read.
        server = self.serve()
        with server.connect() as s:
            s.sendall(b'GET /big.bin HTTP/1.1\r\n\r\n')
            s.recv(1000)
            server.process.send_signal(signal.SIGTERM)
            time.sleep(0.3)
            self.assertIsNone(server.process.poll())
            server.process.send_signal(signal.SIGTERM)
            self.assertEqual(server.process.wait(timeout=3), 0)

    def test_what_it_says(self):
        server = self.serve()
        self.assertEqual(server.said['url'], f'http://127.0.0.1:{server.port}/')
        ran = self.vsplit('serve', 'public', '--port', str(server.port), code=1)
        self.assertIn('Address already in use', ran.err)
        self.vsplit('serve', 'nowhere', '--port', '0', code=BAD_INPUT)
        self.vsplit('serve', 'key', '--port', '0', code=BAD_INPUT)
        self.vsplit('serve', 'public', '--port', '70000', code=USAGE)
        self.vsplit('serve', 'public', '--host', 'no.such.host.invalid', code=1)
        process = subprocess.Popen([harness.VSPLIT, 'serve', 'public', '--port', '0', '--quiet'], cwd=self.folder, stdout=subprocess.PIPE)
        time.sleep(0.3)
        process.terminate()
        self.assertEqual((process.communicate(timeout=10)[0], process.returncode), (b'', 0))


if __name__ == '__main__':
    main()
