"""The door to pycolmap: four stages on a folder, each of which goes on where it was interrupted.

Everything else in this package speaks `Engine`, so that it can be tested without the package.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from photograd._extras import import_extra
from photograd._signals import stop_on_signals
from photograd.errors import IoError, SceneError, message

UPGRADE = "pip install --upgrade pycolmap"
_POLL_S = 0.1


@dataclass(frozen=True)
class Reconstructed:
    """One connected model.

    Attributes:
        names: photographs that have a pose.
        points: number of points.
        error: mean distance in pixels between where points were seen and where the model puts them.
    """

    names: tuple[str, ...]
    points: int
    error: float


class Engine(Protocol):
    """Structure from motion on photographs in a folder, by their names."""

    def enter(self, groups: Sequence[Sequence[str]]) -> None:
        """List the photographs, one group for each camera; the same list again changes nothing.

        Args:
            groups: names of photographs; those of a group have one camera.
        """

    def extracted(self) -> set[str]:
        """Photographs whose features are known."""

    def extract(self, names: Sequence[str]) -> None:
        """Find features.

        Args:
            names: of photographs.
        """

    def pending(self, pairs: Iterable[tuple[str, str]]) -> list[tuple[str, str]]:
        """Those of the pairs that have not been compared."""

    def match(self, pairs: Sequence[tuple[str, str]]) -> None:
        """Compare pairs and check that one geometry explains what they share."""

    def map(
        self, folder: Path, agreeing: int, on_photograph: Callable[[], None]
    ) -> list[Reconstructed]:
        """Recover poses and points; writes COLMAP's binary models folder/0, /1 ..., largest first.

        Args:
            folder: replaced if there is a model at all.
            agreeing: points that must agree about a photograph's pose.
            on_photograph: called for each photograph that has got a pose.
        """


@dataclass(frozen=True)
class Settings:
    """What the result depends on, besides the photographs.

    Attributes:
        seed: of everything random in matching and mapping.
        max_size: longer side in pixels at which features are looked for; smaller is faster.
        max_features: most in one photograph.
    """

    seed: int = 0
    max_size: int = 2000
    max_features: int = 8192


def open_engine(folder: Path, photographs: Path, settings: Settings, threads: int) -> Engine:
    """The engine that pycolmap is, with its database in `folder`.

    Args:
        folder: for the database.
        photographs: folder of the images.
        settings: of the reconstruction.
        threads: of the engine.

    Raises:
        IoError: pycolmap is not installed.
    """
    return _Pycolmap(_import(), folder / "database.db", photographs, settings, threads)


def _import() -> Any:
    pycolmap = import_extra("capture", "pycolmap", "sfm")
    if not hasattr(pycolmap, "CancellationToken"):
        got = getattr(pycolmap, "__version__", "another")
        raise IoError(message("capture", "--photos", "pycolmap from 4.2 on", got, UPGRADE))
    return pycolmap


class _Pycolmap:
    def __init__(
        self, module: Any, database: Path, photographs: Path, settings: Settings, threads: int
    ) -> None:
        self.module, self.database, self.photographs = module, database, photographs
        self.settings, self.threads = settings, threads or -1
        module.logging.minloglevel = int(module.logging.Level.ERROR)  # it has bars of its own kind
        module.set_random_seed(settings.seed)

    def enter(self, groups: Sequence[Sequence[str]]) -> None:
        wanted = {name for group in groups for name in group}
        if self.database.exists():
            with self._open() as database:
                if {image.name for image in database.read_all_images()} == wanted:
                    return
            self.database.unlink()  # from a list that was cut off; nothing was found by then
        with self._open():
            pass  # makes the file
        # Before features are found, by several threads: numbers follow the order of the names, and
        # with them every later choice.
        for group in groups:
            self.module.import_images(
                self.database, self.photographs, self.module.CameraMode.SINGLE, list(group)
            )

    def extracted(self) -> set[str]:
        with self._open() as database:
            return {
                image.name
                for image in database.read_all_images()
                if database.exists_descriptors(image.image_id)
            }

    def extract(self, names: Sequence[str]) -> None:
        options = self.module.FeatureExtractionOptions()
        options.max_image_size = self.settings.max_size
        options.num_threads = self.threads
        options.sift.max_num_features = self.settings.max_features
        self._run(
            self.module.extract_features,
            self.database,
            self.photographs,
            image_names=list(names),
            extraction_options=options,
            device=self.module.Device.cpu,
        )
        missing = sorted(set(names) - self.extracted())
        if missing:
            expected = "features in every photograph"
            got = f"none in {', '.join(missing[:4])}"
            raise SceneError(message("capture", "features", expected, got, "leave these out"))

    def pending(self, pairs: Iterable[tuple[str, str]]) -> list[tuple[str, str]]:
        with self._open() as database:
            ids = {image.name: image.image_id for image in database.read_all_images()}
            return [
                pair
                for pair in pairs
                if not database.exists_two_view_geometry(ids[pair[0]], ids[pair[1]])
            ]

    def match(self, pairs: Sequence[tuple[str, str]]) -> None:
        listed = self.database.with_name("pairs.txt")
        listed.write_text("".join(f"{a} {b}\n" for a, b in pairs), encoding="utf-8")
        pairing = self.module.ImportedPairingOptions()
        pairing.match_list_path = listed
        matching = self.module.FeatureMatchingOptions()
        matching.num_threads = self.threads
        verification = self.module.TwoViewGeometryOptions()
        verification.ransac.random_seed = self.settings.seed
        self._run(
            self.module.match_image_pairs,
            self.database,
            matching_options=matching,
            pairing_options=pairing,
            verification_options=verification,
            device=self.module.Device.cpu,
        )
        listed.unlink()

    def map(
        self, folder: Path, agreeing: int, on_photograph: Callable[[], None]
    ) -> list[Reconstructed]:
        options = self.module.IncrementalPipelineOptions()
        options.num_threads = self.threads
        options.min_model_size = 3
        options.mapper.abs_pose_min_num_inliers = agreeing
        for part in (options, options.mapper, options.triangulation):
            part.random_seed = self.settings.seed
        partial = folder.with_name(f".{folder.name}.partial")
        shutil.rmtree(partial, ignore_errors=True)
        partial.mkdir(parents=True)

        def two() -> None:
            on_photograph()
            on_photograph()

        found = self._run(
            self.module.incremental_mapping,
            self.database,
            self.photographs,
            partial,
            options=options,
            initial_image_pair_callback=two,
            next_image_callback=on_photograph,
        )
        models = sorted(found.values(), key=lambda model: -model.num_reg_images())
        shutil.rmtree(partial)
        for index, model in enumerate(models):
            (partial / f"{index}").mkdir(parents=True)
            model.write_binary(partial / f"{index}")
        if models:
            shutil.rmtree(folder, ignore_errors=True)
            partial.replace(folder)
        return [
            Reconstructed(
                names=tuple(sorted(model.image(i).name for i in model.reg_image_ids())),
                points=model.num_points3D(),
                error=model.compute_mean_reprojection_error(),
            )
            for model in models
        ]

    @contextmanager
    def _open(self) -> Iterator[Any]:
        database = self.module.Database.open(self.database)
        try:
            yield database
        finally:
            database.close()

    def _run(self, stage: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
        """The stage in a thread of its own, so that signals are heard and end it politely.

        It ends at the next photograph or pair; until then more of them change nothing, since an
        interpreter that left before its threads would crash.
        """
        token = self.module.CancellationToken()
        hold = stop_on_signals(token.cancel, all_of_them=True)
        with hold as stopping, ThreadPoolExecutor(1) as pool:
            future = pool.submit(stage, *arguments, **options, cancellation_token=token)
            while not future.done():
                wait([future], timeout=_POLL_S)
        stopping.deliver()
        return future.result()
