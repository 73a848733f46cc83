"""What the lint enforces, as tables. To allow something new, change a table here and say why."""

import re
from dataclasses import dataclass

MAX_FILE_LINES = 400
MAX_FUNCTION_LINES = 60

# Data flows one way: capture -> optics -> fit -> service.
# A file belongs to the longest folder that holds it and may include from these folders of ours.
# "proto" stands for the headers generated from proto/eyebox/v1.
MAY_INCLUDE = {
    "capture": ["capture"],
    "capture/base": ["capture/base"],
    "capture/recording": ["capture", "proto"],
    "optics": ["optics", "capture/base"],
    "fit": ["fit", "optics", "capture/base"],
    "service": ["service", "fit", "optics", "capture", "proto"],
    "tests": ["tests", "service", "fit", "optics", "capture", "proto"],
}


@dataclass(frozen=True)
class Library:
    name: str
    headers: str  # regular expression, matches the whole include path
    places: tuple  # globs of the files that may include it; * also matches /


# Tests may include any library. A header that no row knows is an error: add its row first.
THIRD_PARTY = [
    Library("C++ standard library", r"[a-z_]+", ("*",)),
    Library("POSIX and C", r"(sys|linux|netinet|arpa)/[a-z0-9_]+\.h|"
            r"(dirent|errno|fcntl|poll|pthread|pwd|grp|sched|signal|stdint|termios|time|unistd)\.h",
            ("*.cc",)),
    Library("Abseil", r"absl/.*", ("*",)),
    Library("Aravis", r"arv\.h|aravis.*", ("capture/camera/aravis/*.cc",)),
    Library("GLib", r"glib.*|gio/.*", ("capture/camera/aravis/*.cc",)),
    Library("V4L2", r"linux/videodev2\.h|libv4l.*", ("capture/camera/v4l2/*.cc",)),
    Library("libgpiod", r"gpiod\.h.*", ("capture/trigger/*.cc",)),
    Library("libiio", r"iio\.h", ("capture/photodiode/*.cc",)),
    Library("HDF5", r"hdf5.*|H5.*", ("capture/recording/*.cc",)),
    Library("xxHash", r"xxhash\.h|xxh3\.h", ("capture/*.cc",)),
    Library("OpenCV core", r"opencv2/core(/.*)?(\.hpp)?", ("capture/*.cc", "optics/*.cc")),
    Library("OpenCV imgproc, calib3d", r"opencv2/(imgproc|calib3d)(/.*)?\.hpp", ("optics/*.cc",)),
    # Markers of a ChArUco board, which tell a partial view.
    Library("OpenCV aruco", r"opencv2/aruco(/.*)?\.hpp", ("optics/geometry/*.cc",)),
    Library("libpng", r"png\.h", ("capture/base/png.cc",)),
    # OpenCV decodes 8-bit TIFF by a call that goes on after errors and fills in black.
    Library("libtiff", r"tiffio\.h", ("capture/base/tiff.cc",)),
    Library("Ceres", r"ceres/.*", ("fit/*.cc",)),
    Library("Eigen", r"Eigen/.*", ("fit/*.cc", "optics/*.cc")),
    Library("Protocol Buffers", r"google/(protobuf|rpc)/.*", ("service/*", "capture/recording/*")),
    Library("gRPC", r"grpc(pp)?/.*|eyebox/v1/.*\.grpc\.pb\.h", ("service/*",)),
    Library("CLI11", r"CLI/.*", ("service/cli/*",)),
    Library("printing", r"iostream|print|fmt/.*|spdlog/.*", ("service/*",)),
    Library("OpenSSL", r"openssl/.*", ("service/*.cc",)),
    Library("prometheus-cpp", r"prometheus/.*", ("service/server/observe/metrics.cc",)),
    Library("SQLiteCpp", r"SQLiteCpp/.*", ("service/server/catalogue/index_file.cc",)),
    Library("GoogleTest", r"g(test|mock)/.*", ()),
    Library("rapidcheck", r"rapidcheck.*", ()),
    Library("Google Benchmark", r"benchmark/.*", ()),
    Library("Boost", r"boost/.*", ()),
]


@dataclass(frozen=True)
class Ban:
    what: str
    pattern: re.Pattern  # searched in each line of code, comments and strings blanked
    files: str  # glob of the files it is looked for in
    places: tuple  # globs of the files where it may stand
    instead: str


CODE_BANS = [
    Ban("printing", re.compile(r"std::(cout|cerr|clog)|(?<!\w)(std::)?(v?f?printf|f?puts|putchar|"
                               r"perror)\s*\(|\bfmt::print|\bspdlog::"),
        "*", ("service/*", "tests/*"), "return a status or a value; service prints"),
    Ban("throw", re.compile(r"\bthrow\b"), "*", ("tests/*",),
        "return an absl::Status; no exception crosses a folder"),
    Ban("using namespace", re.compile(r"\busing\s+namespace\b"), "*.h", (),
        "name what is used; a header decides for everyone who includes it"),
]

# Searched in every line of every text file, comments included.
TEXT_BANS = [
    Ban("a path of one machine", re.compile(r"(?<![\w.$}])/(?:work|root|home)/"), "*", (),
        "use a path relative to the source or build folder"),
    Ban("the data folder beside the project", re.compile(r"\bshared/"), "*", ("tests/*",),
        "only tests know it"),
    Ban("a globbed source list", re.compile(r"\bfile\s*\(\s*GLOB", re.IGNORECASE),
        "*CMakeLists.txt", (), "list sources by name"),
    Ban("-ffast-math", re.compile(r"-ffast-math\b"), "*CMake*", (),
        "NaN marks invalid pixels; fast-math assumes there is none"),
]
