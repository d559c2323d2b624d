"""Files of measurements: JSON, compressed so that new ones hardly weigh on the history."""
import gzip
import json


def read(path):
    """Returns the content of a file NAME.json.gz. Raises OSError or ValueError where it cannot."""
    return json.loads(gzip.decompress(path.read_bytes()).decode("utf-8"))


def write(path, content):
    """Writes a file NAME.json.gz whose bytes depend on its content alone."""
    text = json.dumps(content, ensure_ascii=False, separators=(",", ":")) + "\n"
    path.write_bytes(gzip.compress(text.encode("utf-8"), mtime=0))
