"""A LeRobotDataset of version 3.0 on disk, written with pyarrow alone.

`meta/info.json` names the features, `meta/tasks.parquet` the tasks, `meta/episodes/` where each episode is and its
statistics, `meta/stats.json` the statistics of all; `data/` has the frames, here one file for an episode, pictures as
JPEG in it. Each file is replaced at once, and `info.json`, which says how many episodes count, comes last: an episode
that is interrupted leaves the dataset as it was.
Source: https://huggingface.co/docs/lerobot/lerobot-dataset-v3
"""

import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from PIL import Image

from cli.demonstrations.sampler import Episode, Picture
from cli.demonstrations.statistics import Statistics, merged, of_pictures, of_values
from cli.errors import CliError
from common.demonstration import ACTION, STATE
from common.files.atomic_file import replace
from common.rendering.encode import jpeg

VERSION = "v3.0"
CHUNK = 1000
"""Files in a folder, as LeRobot has it."""
JPEG_QUALITY = 90
"""Of the data set's pictures [1 to 95]; chosen: policies are trained on them."""
DATA = "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"
EPISODES = "meta/episodes/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"
COUNTERS = {"frame_index": "int64", "episode_index": "int64", "index": "int64", "task_index": "int64"}
IMAGE = pa.struct([("bytes", pa.binary()), ("path", pa.string())])
Json = dict[str, Any]


class Dataset:
    """The dataset in `root`, new or continued.

    Raises:
        CliError: something else is there, or a dataset of other features, rate or version.
    """

    def __init__(self, root: Path, fps: int, cameras: Mapping[str, tuple[int, int]]) -> None:
        self.root, self._fps = root, fps
        self._cameras = {f"observation.images.{name}": size for name, size in cameras.items()}
        self._info = self._fresh()
        self._tasks: list[str] = []
        self._episodes: list[Json] = []
        if (root / "meta" / "info.json").exists():
            self._continue()
        elif root.exists() and any(root.iterdir()):
            raise CliError(f"{root} is not empty and has no meta/info.json; give a new folder, or one with a dataset")

    @property
    def episodes(self) -> int:
        """Number of episodes in the data set."""
        return int(self._info["total_episodes"])

    @property
    def frames(self) -> int:
        """Frames of all episodes [count]."""
        return int(self._info["total_frames"])

    def add(self, episode: Episode) -> None:
        """Write an episode with at least one frame.

        Raises:
            OSError: the disk does not take it.
        """
        number, first = self.episodes, self.frames
        if episode.task not in self._tasks:
            self._tasks.append(episode.task)
        table, stats = self._table(episode, number, first, self._tasks.index(episode.task))
        chunk, file = divmod(number, CHUNK)
        self._write(DATA.format(chunk_index=chunk, file_index=file), table)
        row: Json = {
            "episode_index": number, "tasks": [episode.task], "length": len(episode.frames),
            "data/chunk_index": chunk, "data/file_index": file,
            "dataset_from_index": first, "dataset_to_index": first + len(episode.frames),
            "meta/episodes/chunk_index": chunk, "meta/episodes/file_index": 0,
        }  # fmt: skip
        for key, values in stats.items():
            row |= {f"stats/{key}/{name}": value for name, value in values.items()}
        self._episodes.append(row)
        rows = [r for r in self._episodes if r["meta/episodes/chunk_index"] == chunk]
        self._write(EPISODES.format(chunk_index=chunk, file_index=0), pa.Table.from_pylist(rows))
        self._write("meta/tasks.parquet", _task_table(self._tasks))
        self._save("meta/stats.json", self._statistics(stats))
        self._info |= {
            "total_episodes": number + 1, "total_frames": first + len(episode.frames), "total_tasks": len(self._tasks),
            "splits": {"train": f"0:{number + 1}"},
        }  # fmt: skip
        self._save("meta/info.json", self._info)

    # --- what is there
    def _fresh(self) -> Json:
        features: Json = {
            "observation.state": {"dtype": "float32", "shape": [len(STATE)], "names": list(STATE)},
            "action": {"dtype": "float32", "shape": [len(ACTION)], "names": list(ACTION)},
            "next.done": {"dtype": "bool", "shape": [1], "names": None},
            "next.success": {"dtype": "bool", "shape": [1], "names": None},
        }
        for key, (width, height) in self._cameras.items():
            features[key] = {"dtype": "image", "shape": [height, width, 3], "names": ["height", "width", "channels"]}
        features["timestamp"] = {"dtype": "float32", "shape": [1], "names": None}
        features |= {name: {"dtype": kind, "shape": [1], "names": None} for name, kind in COUNTERS.items()}
        return {
            "codebase_version": VERSION, "robot_type": "tidybot", "total_episodes": 0, "total_frames": 0,
            "total_tasks": 0, "chunks_size": CHUNK, "data_files_size_in_mb": 100, "video_files_size_in_mb": 200,
            "fps": self._fps, "splits": {}, "data_path": DATA, "video_path": None, "features": features,
        }  # fmt: skip

    def _continue(self) -> None:
        path = self.root / "meta" / "info.json"
        try:
            info = json.loads(path.read_text(encoding="utf-8"))
            for key in ("codebase_version", "fps", "features"):
                if info[key] != self._info[key]:
                    raise CliError(f"{path}: another {key.replace('_', ' ')} than this recording's; give a new folder")
            self._info = info
            if self.episodes:
                self._tasks = pq.read_table(self.root / "meta" / "tasks.parquet").column("task").to_pylist()
            for file in sorted((self.root / "meta" / "episodes").glob("*/*.parquet")):
                self._episodes += pq.read_table(file).to_pylist()
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise CliError(f"{path}: not a dataset that can be continued: {error}") from None
        # One more than `info.json` knows of was interrupted.
        self._episodes = [row for row in self._episodes if row["episode_index"] < self.episodes]

    # --- what is written
    def _table(self, episode: Episode, number: int, first: int, task: int) -> tuple[pa.Table, Mapping[str, Statistics]]:
        frames = episode.frames
        count = len(frames)
        last = np.arange(count) == count - 1
        values: dict[str, Any] = {
            "observation.state": np.array([f.state for f in frames], np.float32),
            "action": np.array([f.action for f in frames], np.float32),
            "next.done": last,
            "next.success": last & (episode.outcome == "delivered"),
            "timestamp": (np.arange(count) / self._fps).astype(np.float32),
            "frame_index": np.arange(count),
            "episode_index": np.full(count, number),
            "index": np.arange(first, first + count),
            "task_index": np.full(count, task),
        }
        columns: dict[str, pa.Array] = {}
        stats: dict[str, Statistics] = {}
        for key in self._info["features"]:
            if key in self._cameras:
                pictures = [f.pictures[key.rpartition(".")[2]] for f in frames]
                columns[key] = pa.array([{"bytes": _jpeg(p), "path": None} for p in pictures], IMAGE)
                stats[key] = of_pictures(pictures)
            else:
                columns[key] = _column(values[key])
                stats[key] = of_values(values[key])
        return pa.table(columns).replace_schema_metadata(_hub_schema(self._info["features"])), stats

    def _statistics(self, newest: Mapping[str, Statistics]) -> Json:
        """Statistics of all episodes, by feature."""
        names = tuple(next(iter(newest.values())))
        return {
            key: merged([{name: row[f"stats/{key}/{name}"] for name in names} for row in self._episodes])
            for key in newest
        }

    def _write(self, name: str, table: pa.Table) -> None:
        out = io.BytesIO()
        pq.write_table(table, out, compression="snappy")
        self._put(name, out.getvalue())

    def _save(self, name: str, value: Json) -> None:
        self._put(name, json.dumps(value, indent=4).encode())

    def _put(self, name: str, content: bytes) -> None:
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if why := replace(path, content):
            raise OSError(why)


def _column(values: Any) -> pa.Array:
    if values.ndim == 1:
        return pa.array(values)
    return pa.FixedSizeListArray.from_arrays(pa.array(values.ravel()), values.shape[1])


def _jpeg(picture: Picture) -> bytes:
    return jpeg(Image.frombytes("RGB", (picture.width, picture.height), picture.rgb), JPEG_QUALITY)


def _task_table(tasks: Sequence[str]) -> pa.Table:
    """Tasks as the index of a pandas table, which is how LeRobot looks them up."""
    column = {"metadata": None, "field_name": "task_index", "name": "task_index", "pandas_type": "int64"}
    index = {"metadata": None, "field_name": "task", "name": "task", "pandas_type": "unicode", "numpy_type": "object"}
    about = {
        "index_columns": ["task"], "column_indexes": [], "columns": [{**column, "numpy_type": "int64"}, index],
        "creator": {"library": "pyarrow", "version": pa.__version__}, "pandas_version": "2.2.0",
    }  # fmt: skip
    table = pa.table({"task_index": pa.array(range(len(tasks)), pa.int64()), "task": pa.array(tasks, pa.string())})
    return table.replace_schema_metadata({b"pandas": json.dumps(about).encode()})


def _hub_schema(features: Json) -> dict[bytes, bytes]:
    """The columns' types in the words of the `datasets` package, so that it decodes pictures."""

    def kind(feature: Json) -> Json:
        if feature["dtype"] == "image":
            return {"_type": "Image"}
        value = {"dtype": feature["dtype"], "_type": "Value"}
        size = feature["shape"][0]
        return {"feature": value, "length": size, "_type": "Sequence"} if size > 1 else value

    about = {"info": {"features": {key: kind(feature) for key, feature in features.items()}}}
    return {b"huggingface": json.dumps(about).encode()}
