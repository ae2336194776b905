#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""boundary_test.py SOURCE_DIR: who may name what. The copyleft and the heavy dependencies stay in their rooms, and every source
file says its licence. First the rules are shown to bite, on a small house with every fault planted in it."""
import pathlib
import re
import sys
import tempfile

CODE = {'.cpp', '.hpp', '.h', '.c', '.cc', '.ipp'}
SCRIPTS = {'.py', '.mjs', '.js', '.sh', '.cmake'}
SKIPPED = {'build', 'dist', 'out', 'node_modules', '.git', '__pycache__', 'LICENSES'}

# Folders, what may not be there, why. `names`: anywhere in the text, comments too; `includes`: in an #include.
NAMES_FORBIDDEN = re.compile(r'CGAL|OpenMesh|tiny_?gltf|\bVTK\b|\bvtk[A-Z]', re.IGNORECASE)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^>"]+)[>"]', re.MULTILINE)
ROOMS = [
    # (pattern of the included path, folders that may, name)
    (re.compile(r'^CGAL/'), ('baker/surface/', 'baker/points/', 'tests/unit/surface_', 'tests/unit/points_', 'tests/bench/powercrust/', 'tests/bench/simplify/peer_cgal'), 'CGAL'),
    (re.compile(r'(^|/)tiny_?gltf(_v3)?\.h$'), ('baker/gltf/', 'tests/unit/gltf_', 'tests/bench/assets/scene'), 'tinygltf'),
    (re.compile(r'^OpenMesh/'), ('baker/collapse/', 'tests/unit/collapse_', 'tests/unit/meshes_', 'tests/bench/simplify/peer_openmesh'), 'OpenMesh'),
    (re.compile(r'^vtk[A-Z]'), ('viewer/desktop/', 'tests/bench/simplify/peer_vtk'), 'VTK'),
]
GPL_FOLDERS = ('baker/surface/', 'baker/points/')
# Outside of these two, what includes CGAL to test or to measure it.
GPL_TESTS = re.compile(r'tests/(unit/(surface|points)_|bench/powercrust/|bench/simplify/peer_cgal)')


def files(root):
    for path in sorted(root.rglob('*')):
        relative = path.relative_to(root)
        # Hidden folders are other people's: .git, .ci's caches.
        if any(part in SKIPPED or part.startswith('build') for part in relative.parts) or not path.is_file():
            continue
        yield path, relative.as_posix()


def faults(root):
    found = []
    for path, name in files(root):
        is_code = path.suffix in CODE
        is_source = is_code or path.suffix in SCRIPTS or path.name in ('CMakeLists.txt', 'run')
        if not is_source and not name.startswith('formats/'):
            continue
        text = path.read_text(encoding='utf-8', errors='replace')
        if (name.startswith('lib/') and is_code) or name.startswith('formats/'):
            for match in NAMES_FORBIDDEN.finditer(text):
                line = text.count('\n', 0, match.start()) + 1
                found.append(f'{name}:{line}: names {match.group()}')
        if not is_source:
            continue
        for match in INCLUDE.finditer(text):
            for pattern, allowed, what in ROOMS:
                if pattern.search(match.group(1)) and not name.startswith(allowed):
                    found.append(f'{name}:{text.count(chr(10), 0, match.start(1)) + 1}: includes {what}')
        if path.name == 'CMakeLists.txt' and not name.startswith(GPL_FOLDERS) and not name.startswith('tests/'):
            if re.search(r'find_package\s*\(\s*CGAL|CGAL::', text):
                found.append(f'{name}: links CGAL')
        head = text.splitlines()[:5]
        licence = [line.split('SPDX-License-Identifier:')[1].strip() for line in head if 'SPDX-License-Identifier:' in line]
        if not licence or not any('SPDX-FileCopyrightText:' in line for line in head):
            found.append(f'{name}: has no SPDX head')
        elif name.startswith(GPL_FOLDERS) and not licence[0].startswith('GPL-3.0-or-later'):
            found.append(f'{name}: links CGAL, so it is GPL-3.0-or-later, not {licence[0]}')
        elif not name.startswith(GPL_FOLDERS) and licence[0] != 'MIT' and not GPL_TESTS.match(name):
            found.append(f'{name}: is {licence[0]}, not MIT')
    return found


MIT = '// SPDX-FileCopyrightText: 2026 X\n// SPDX-License-Identifier: MIT\n'
GPL = MIT.replace('MIT', 'GPL-3.0-or-later')
PLANTED = {
    'lib/live/a.cpp': (MIT + '// as in OpenMesh\n', 'lib/live/a.cpp:3: names OpenMesh'),
    'lib/include/vsplit/b.hpp': (MIT + 'struct CGAL_like {};\n', 'lib/include/vsplit/b.hpp:3: names CGAL'),
    'lib/c/c.h': (MIT + '#include "tiny_gltf.h"\n', 'lib/c/c.h:3: includes tinygltf'),
    'formats/spec/d.md': ('made by VTK\n', 'formats/spec/d.md:1: names VTK'),
    'baker/app/e.cpp': (MIT + '#  include <CGAL/Kernel.h>\n', 'baker/app/e.cpp:3: includes CGAL'),
    'baker/meshes/f.cpp': (MIT + '#include <tiny_gltf.h>\n', 'baker/meshes/f.cpp:3: includes tinygltf'),
    'baker/samples/g.cpp': (MIT + '#include <OpenMesh/Core/IO/MeshIO.hh>\n', 'baker/samples/g.cpp:3: includes OpenMesh'),
    'baker/app/h.cpp': ('int main() {}\n', 'baker/app/h.cpp: has no SPDX head'),
    'baker/surface/i.cpp': (MIT, 'baker/surface/i.cpp: links CGAL, so it is GPL-3.0-or-later, not MIT'),
    'baker/gltf/j.cpp': (GPL, 'baker/gltf/j.cpp: is GPL-3.0-or-later, not MIT'),
    'baker/gltf/CMakeLists.txt': (MIT.replace('//', '#') + 'target_link_libraries(x CGAL::CGAL)\n', 'baker/gltf/CMakeLists.txt: links CGAL'),
    'tests/cli/k.py': ('print()\n', 'tests/cli/k.py: has no SPDX head'),
    # And what is right stays unsaid.
    'baker/points/l.cpp': (GPL + '#include <CGAL/Kernel.h>\n', None),
    'baker/gltf/m.cpp': (MIT + '#include <tiny_gltf.h>\n', None),
    'lib/CMakeLists.txt': (MIT.replace('//', '#') + 'target_compile_definitions(vsplit PRIVATE CGAL_LICENSE_ERROR)\n', None),
}


def rules_bite():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, (text, _) in PLANTED.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        found = set(faults(root))
        expected = {message for _, message in PLANTED.values() if message}
        missed, invented = expected - found, found - expected - {'lib/c/c.h:3: names tiny_gltf'}
        for message in missed:
            print(f'the rules do not see: {message}')
        for message in invented:
            print(f'the rules invent: {message}')
        return not missed and not invented


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    root = pathlib.Path(sys.argv[1])
    if not rules_bite():
        return 1
    if not (root / 'lib/include/vsplit/mesh.hpp').is_file() or not (root / 'baker/gltf').is_dir():
        print(f'{root} is not the source tree')
        return 1
    found = faults(root)
    for fault in found:
        print(fault)
    print(f'{len(found)} faults')
    return 1 if found else 0


if __name__ == '__main__':
    sys.exit(main())
