"""Versions of the software and the machine in a run folder."""

from datetime import date

import pytest

from supervision.versions import processor, provenance, versions

X86 = """processor\t: 0
vendor_id\t: GenuineIntel
cpu family\t: 6
model\t\t: 85
model name\t: Intel(R) Xeon(R) CPU @ 2.00GHz
flags\t\t: fpu sse2 avx fma avx2 avx512f

processor\t: 1
cpu family\t: 6
model\t\t: 85
"""
ARM = """processor\t: 0
BogoMIPS\t: 243.75
Features\t: fp asimd evtstrm aes
CPU implementer\t: 0x41
CPU part\t: 0xd0c
"""


@pytest.mark.parametrize(
    "cpuinfo, expected",
    [
        (X86, "Intel(R) Xeon(R) CPU @ 2.00GHz family 6 model 85 avx512f"),
        (X86.replace(" avx512f", ""), "Intel(R) Xeon(R) CPU @ 2.00GHz family 6 model 85 avx2"),
        (ARM, "implementer 0x41 part 0xd0c asimd"),
    ],
)
def test_the_processor_is_named_with_its_widest_vector_unit(tmp_path, cpuinfo, expected):
    (tmp_path / "cpuinfo").write_text(cpuinfo)
    assert processor(tmp_path / "cpuinfo") == expected


@pytest.mark.parametrize("content", [None, "", "no colon here\n"])
def test_a_processor_without_information_is_unknown(tmp_path, content):
    if content is not None:
        (tmp_path / "cpuinfo").write_text(content)
    assert processor(tmp_path / "cpuinfo") == "unknown"


def test_versions_name_the_processor():
    assert versions()["processor"] == processor()


def test_the_provenance_of_a_report_has_its_date_and_machine():
    lines = provenance(date(2026, 11, 29)).splitlines()
    assert lines[0].startswith("* Date and commit: 2026-11-29, ")
    assert lines[1].startswith("* Machine: ")
