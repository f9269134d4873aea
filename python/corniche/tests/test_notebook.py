"""The notebook in examples/ runs from its first cell to its last, and shows the outputs that its text names."""

from __future__ import annotations

import base64
import urllib.request
from pathlib import Path

import pytest

NOTEBOOK = Path(__file__).resolve().parents[3] / "examples" / "notebook" / "pass.ipynb"
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("geopandas")
pytest.importorskip("matplotlib")
pytestmark = pytest.mark.skipif(not NOTEBOOK.is_file(), reason="only in the repository")


@pytest.mark.usefixtures("program")
def test_the_notebook_runs_and_shows_tables_pictures_and_a_map(tmp_path: Path) -> None:
    import nbformat

    notebook = nbformat.read(NOTEBOOK, as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells), "what it printed is not kept"
    folder = tmp_path / "run"
    folder.mkdir()
    client = nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(folder)}})
    with client.setup_kernel():
        for number, cell in enumerate(notebook.cells):
            client.execute_cell(cell, number)
        shown = [output for cell in notebook.cells for output in cell.get("outputs", []) if "data" in output]
        pages = [output.data["text/html"] for output in shown if "text/html" in output.data]
        assert sum("<table" in page for page in pages) == 2, "levels and steepest roads"
        assert any("steepest_pct" in page and "LINESTRING Z" in page for page in pages)
        pictures = [base64.b64decode(output.data["image/png"]) for output in shown if "image/png" in output.data]
        assert len(pictures) == 2 and all(len(picture) > 5000 for picture in pictures)
        (frame,) = [page for page in pages if "<iframe" in page]
        url = frame.split('src="')[1].split('"')[0]
        with urllib.request.build_opener(urllib.request.ProxyHandler({})).open(url, timeout=20) as answer:
            assert b"<title>" in answer.read()
    assert {"pass.pmtiles", "edges.gpkg", "profile.csv"} <= {path.name for path in folder.iterdir()}
