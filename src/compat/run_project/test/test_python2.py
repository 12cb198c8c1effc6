import pytest

from run_project.preparation.python2 import to_python3


@pytest.mark.parametrize(
    ("source", "converted"),
    [
        ("print 'hello'\n", "print('hello')\n"),
        (
            "try:\n    x()\nexcept ValueError, e:\n    print e",
            "try:\n    x()\nexcept ValueError as e:\n    print(e)\n",
        ),
        ("if a:\n\tb()\n        c()\n", "if a:\n        b()\n        c()\n"),
    ],
)
def test_python_2_becomes_python_3(source, converted):
    assert to_python3(source) == converted


@pytest.mark.parametrize("source", ["print('hello')\n", "\tno python at all (\n", "\0", ""])
def test_other_texts_are_unchanged(source):
    assert to_python3(source) == source
