#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""Golden files are read as they always were, by the library and by the reference decoder, at every prefix; malformed
files are refused with the code that their name begins with.

    golden_test.py FORMATS DIGEST            check
    golden_test.py FORMATS DIGEST --update MAKE   write all of them anew (only while a version is being made)
"""
import pathlib
import shutil
import subprocess
import sys

formats, digest = pathlib.Path(sys.argv[1]), sys.argv[2]


def read(command):
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    return done.returncode, done.stdout, done.stderr


if '--update' in sys.argv:
    subprocess.run([sys.argv[4], str(formats)], check=True)
    for golden in sorted((formats / 'golden').glob('*.pmesh')):
        golden.with_suffix('.txt').write_text(read([digest, golden])[1])

failures = []
goldens = sorted((formats / 'golden').glob('*.pmesh'))
if len(goldens) < 10:
    failures.append('there are only %d golden files' % len(goldens))
reference = shutil.which('draco_decoder') is not None
if not reference:
    print('SKIPPED: the reference decoder, draco_decoder is not here (Debian package draco)', file=sys.stderr)
for golden in goldens:
    expected = golden.with_suffix('.txt').read_text()
    if read([digest, golden]) != (0, expected, ''):
        failures.append('%s: the library reads it otherwise' % golden.name)
    if reference and read([sys.executable, formats / 'decoder' / 'decode.py', golden])[:2] != (0, expected):
        failures.append('%s: the reference decoder reads it otherwise' % golden.name)
bad = sorted((formats / 'malformed').glob('*.pmesh'))
for code in ('malformed', 'unsupported', 'truncated', 'checksum'):
    if not any(f.name.startswith(code) for f in bad):
        failures.append('no malformed file of code ' + code)
for file in bad:
    status, _, message = read([digest, file])
    if status != 1 or not message.startswith(file.name.split('-')[0] + ':'):
        failures.append('%s: exit %d, %s' % (file.name, status, message.strip()))
print('%d golden, %d malformed files' % (len(goldens), len(bad)))
for failure in failures:
    print('FAIL', failure, file=sys.stderr)
sys.exit(1 if failures else 0)
