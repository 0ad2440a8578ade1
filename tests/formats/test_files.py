"""Files: whole or not there, and nothing strange is read."""

import os
import threading

import pytest

from trihex import FormatError, read_area
from trihex.files import check_output, new_file, read_bytes, suffix_of


def test_a_file_is_new_only_when_it_is_whole(tmp_path):
    path = tmp_path / "out.txt"
    path.write_text("old")
    with pytest.raises(KeyboardInterrupt), new_file(path) as part:  # noqa: PT012
        part.write_text("half")
        assert part.suffix == ".txt"
        raise KeyboardInterrupt
    assert path.read_text() == "old"
    with new_file(path) as part:
        part.write_text("new")
        assert path.read_text() == "old"
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def test_mode_and_link_are_kept(tmp_path):
    path, link = tmp_path / "out.txt", tmp_path / "link.txt"
    path.write_text("old")
    path.chmod(0o640)
    link.symlink_to(path)
    with new_file(link) as part:
        part.write_text("new")
    assert link.is_symlink()
    assert path.read_text() == "new"
    assert path.stat().st_mode & 0o777 == 0o640


def test_a_device_is_written_in_place():
    with new_file("/dev/null") as part:
        part.write_text("gone")
    assert not os.path.isfile("/dev/null")


def test_the_user_is_told_the_name_he_knows(tmp_path):
    path = tmp_path / "none" / "out.txt"
    with pytest.raises(FileNotFoundError) as error, new_file(path):
        pass
    assert error.value.filename == str(path)


def test_outputs_are_checked_before_the_work(tmp_path):
    (tmp_path / "file").write_text("")
    check_output(tmp_path / "file")
    check_output(tmp_path / "new")
    with pytest.raises(IsADirectoryError):
        check_output(tmp_path)
    with pytest.raises(FileNotFoundError):
        check_output(tmp_path / "none" / "out")
    with pytest.raises(NotADirectoryError):
        check_output(tmp_path / "file" / "out")


def test_a_pipe_is_read(tmp_path):
    path = tmp_path / "pipe"
    os.mkfifo(path)
    writer = threading.Thread(target=lambda: path.write_text(".D\n"))
    writer.start()
    assert read_area(path).free_count == 2
    writer.join()


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "the file is empty"),
        (b"..\xff.", "must be UTF-8 text; byte 0xff at position 2 is none"),
        (b"\x1f\x8b\x08", "is gzip, which trihex cannot read"),
        (b"x,y\n1,2\n", "must hold an area"),
    ],
)
def test_what_is_no_area(tmp_path, content, message):
    path = tmp_path / "area.txt"
    path.write_bytes(content)
    with pytest.raises(FormatError, match=message):
        read_area(path)


def test_size_is_limited(tmp_path):
    path = tmp_path / "huge.map"
    with open(path, "wb") as file:
        file.truncate(2**40)  # sparse
    with pytest.raises(FormatError, match="must be at most 1073741824 bytes long, not 1099511627776"):
        read_area(path)
    with pytest.raises(FormatError, match="not a device"):
        read_bytes("/dev/zero")


def test_suffixes_have_near_names():
    assert suffix_of("a.CSV", [".csv", ".npz"], "a plan") == ".csv"
    with pytest.raises(
        FormatError, match=r"a.cvs: the suffix of a plan must be one of .csv, .npz, not '.cvs'; did you"
    ):
        suffix_of("a.cvs", [".csv", ".npz"], "a plan")
