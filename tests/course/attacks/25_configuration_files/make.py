"""A conftest that turns failures into passes, and more of its kind."""

from course.attacks.archive import zip_of

CONFTEST = """import pytest


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item, call):
    outcome = yield
    outcome.get_result().outcome = "passed"


def pytest_sessionfinish(session):
    session.exitstatus = 0
"""
CUSTOMIZE = 'import os\nos.write(2, b"escape: code beside the module was run\\n")\n'
MODULE = '__import__("os").write(2, b"token 25\\n")\n'


def variants() -> dict[str, bytes]:
    files = {
        "arena.py": MODULE,
        "conftest.py": CONFTEST,
        "pytest.ini": "[pytest]\naddopts = -q\n",
        "setup.cfg": "[tool:pytest]\naddopts = --collect-only\n",
        "sitecustomize.py": CUSTOMIZE,
        "usercustomize.py": CUSTOMIZE,
        "evil.pth": "import os; os.write(2, b'escape: a pth file was run\\n')\n",
    }
    return {"files": zip_of(files)}
