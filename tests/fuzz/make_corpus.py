#!/usr/bin/env python3
"""Writes the examples that the fuzz targets start from into tests/fuzz/corpus.

Small valid inputs of every kind, and a few whose checksums are mended by the target itself. What
libFuzzer found beside them and is worth keeping lies in the same folders under found-*.
"""

import pathlib
import struct
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
CORPUS = ROOT / "tests/fuzz/corpus"
FIXTURE = ROOT / "fixtures/rift-s-like-seed1"


def put(target, name, content):
    path = CORPUS / target / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content if isinstance(content, bytes) else content.encode())


def field(number, content):
    """A length-delimited field of a protobuf message, below 128 bytes."""
    content = content if isinstance(content, bytes) else content.encode()
    return bytes([number << 3 | 2, len(content)]) + content


def requests():
    names = ["id-1", "jobs/000001", "2024-05/left_eye.1", "linearize.cube", "rift-s", "sim:rift-s-like"]
    for rule, name in enumerate(names):
        put("requests", f"name-{rule}", bytes([rule]) + name.encode())
    put("requests", "parent", b"\x02a/../../other")
    put("requests", "endpoint-tcp", b"\x06[::1]:50051")
    put("requests", "endpoint-unix", b"\x06unix:eyebox.sock")
    sizes = b"\x20\x21\x28\x20"  # hdrp_cube_size 33, pps_strip_size 32
    put("requests", "run-recording", b"\xff" + field(1, "id-1") + field(2, "a/b") + sizes)
    rig = field(1, "lab") + field(2, "sim:rift-s-like") + b"\x18\x07"
    put("requests", "run-rig", b"\xff" + field(1, "id-2") + field(3, rig))
    put("requests", "job-reduce", b"\x08" + field(1, "id-3") + field(3, field(1, field(1, "a/b"))))
    put("requests", "job-tradeoff", b"\x08" + field(1, "id-4") + field(12, field(1, rig)))
    put("requests", "job-plan",
        b"\x08" + field(1, "id-5") + field(13, field(1, "scene.textproto") + field(2, rig)))
    scatter = field(2, field(1, "gaussian") + field(2, "moffat"))
    series = field(1, "a/b")
    put("requests", "job-contrast",
        b"\x08" + field(1, "id-6") + field(14, field(1, series) + field(2, scatter)))
    put("requests", "job-reduce-scatter", b"\x08" + field(1, "id-7") + field(
        3, field(1, series + field(3, scatter) + field(4, "dark"))))
    put("requests", "preview", b"\x09" + field(2, rig) + b"\x28\x40")  # most_width_px 64


def list_recordings():
    put("list_recordings", "all", "")
    put("list_recordings", "words", "state = COMPLETE AND origin != SIMULATED AND series:''\nname desc")
    put("list_recordings", "text", 'rig = "left \\"eye\\"" AND name != recordings/a*\nstart_time')
    put("list_recordings", "numbers", "captures >= 3 AND frames < 100 AND bytes > 0 AND levels=17")
    put("list_recordings", "times",
        "start_time >= 1970-01-01 AND start_time < \"2026-11-01T09:30:00+01:00\"\nstart_time desc")
    put("list_recordings", "token", "\n\nMjAwIDUgcmVjb3JkaW5ncy9h")


def rig_and_plan():
    put("rig_and_plan", "rig", 'name: "lab"\ncamera_uri: "sim:rift-s-like"\nseed: 7\n')
    put("rig_and_plan", "rig-devices",
        'name: "lab"\ncamera_uri: "aravis:"\nphotodiode_uri: "serial:/dev/ttyACM0"\n'
        'trigger_uri: "gpiochip0:4"\nsensor: "sensor"\n')
    whole = (FIXTURE / "recording.textproto").read_text()
    head, *captures = whole.split("\n  captures {")
    captures[-1], tail = captures[-1].split("\n}\n")
    kinds = [next(c for c in captures if kind in c) for kind in ("DARK", "FLAT", "LIGHT")]
    put("rig_and_plan", "recording", "\n  captures {".join([head, *kinds]) + "\n}\n" + tail)
    put("rig_and_plan", "recording-no-plan", whole[:whole.index("plan {")] + tail)


def manifest():
    log = (FIXTURE / "manifest.log").read_bytes()
    ends, at = [], 0
    while at < len(log):
        at += 16 + struct.unpack_from("<I", log, at)[0]
        ends.append(at)
    for name, records in (("header", 1), ("one", 2), ("three", 4)):
        put("manifest", name, b"\0" + log[:ends[records - 1]])
        put("manifest", name + "-mended", b"\1" + log[:ends[records - 1]])
    put("manifest", "torn", b"\0" + log[:ends[1] - 7])


def frame_records():
    pixels = struct.pack("<4H", 1, 2, 3, 4095)
    record = struct.pack("<Qqqq7dQIIiHBBQ", 17, 5, 10**12, 0, 0.0125, 0.0125, 0, 0, 32.0, 21.5, 9.0,
                         0, 0, 0, 3, 0x75, 1, 0, 0)
    assert len(record) == 120
    put("frame_records", "mended", b"\1" + record + pixels)
    put("frame_records", "damaged", b"\0" + record + pixels)
    put("frame_records", "empty", b"\0" + bytes(120) + pixels)
    put("frame_records", "no-pixels", b"\1" + record)


def cube():
    entries = [f"{r} {g} {b}" for b in (0, 1) for g in (0, 1) for r in (0, 1)]
    body = "\n".join(entries) + "\n"
    put("cube", "plain", "LUT_3D_SIZE 2\n" + body)
    put("cube", "adobe", '# made by hand\nTITLE "a table"\nLUT_3D_SIZE 2\nDOMAIN_MIN 0 0 0\n'
        "DOMAIN_MAX 2 2 2\n\n" + body)
    put("cube", "resolve", "LUT_3D_SIZE 2\r\nLUT_3D_INPUT_RANGE 0.0 1.0\r\n" + body.replace("\n", "\r\n"))
    put("cube", "numbers", "LUT_3D_SIZE 2\n" + "-0.5 1e-3 6.5e4\n" * 8)
    put("cube", "short", "LUT_3D_SIZE 2\n" + body[:-6])


def png(width, height, depth, colour, rows):
    def chunk(kind, content):
        return (struct.pack(">I", len(content)) + kind + content
                + struct.pack(">I", zlib.crc32(kind + content)))
    return (b"\x89PNG\r\n\x1a\n"
            + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def tiff(bits, pixels):
    tags = [(256, 4, 2), (257, 4, 2), (258, 3, bits), (259, 3, 1), (262, 3, 1),
            (273, 4, 8 + 2 + 8 * 12 + 4), (278, 4, 2), (279, 4, len(pixels))]
    directory = b"".join(struct.pack("<HHII", tag, kind, 1, value) for tag, kind, value in tags)
    return b"II*\0" + struct.pack("<IH", 8, len(tags)) + directory + bytes(4) + pixels


def strip():
    two = b"".join(b"\0" + bytes(range(row, row + 12)) for row in (0, 100))
    put("strip", "strip-2", png(4, 2, 8, 2, two))
    three = b"".join(b"\0" + bytes(27) for _ in range(3))
    put("strip", "strip-3", png(9, 3, 8, 2, three))
    put("strip", "grey-8", png(3, 2, 8, 0, b"\0\1\2\3\0\4\5\6"))
    put("strip", "grey-16", png(2, 2, 16, 0, b"\0\0\1\0\2\0\0\3\0\4"))
    put("strip", "tiff-8", tiff(8, b"\1\2\3\4"))
    put("strip", "tiff-16", tiff(16, bytes(8)))


def index_csv():
    head = "file,kind,exposure_s,gain_db,series,repeat"
    put("index_csv", "least", head + "\na.tif,light,0.1,0,s,1\nb.png,dark,0.1,0,s,1\n")
    put("index_csv", "all", head + ",pattern,diameter_deg,drive_r,drive_g,drive_b,luminance_cd_m2,"
        "timestamp_s,photodiode_counts,bits\n"
        "a.tif,light,0.1,0,s,1,disk,2.5,0.5,0.5,0.5,,12.25,801,12\n"
        'b.png,flat,0.1,0,"s, quoted",1,full_field,,1,1,1,9,,,\n')
    put("index_csv", "crlf", (head + "\na.tif,light,1e-3,6,,2\n").replace("\n", "\r\n"))
    put("index_csv", "outside", head + "\n../a.tif,light,0.1,0,s,1\n")


def crc16(content):
    crc = 0xffff
    for byte in content:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xffff
    return crc


def framed(payload):
    groups = (payload + struct.pack("<H", crc16(payload))).split(b"\0")
    return b"".join(bytes([len(group) + 1]) + group for group in groups) + b"\0"


def serial_framing():
    state = struct.pack("<BBBBBIII", 2, 9, 1, 12, 1, 1000, 100, 123456)
    samples = struct.pack("<BBII", 1, 3, 40, 5000) + struct.pack("<6H", 0, 800, 1000, 801, 1000, 0)
    put("serial_framing", "state", b"\3\0" + framed(state))
    put("serial_framing", "samples", b"\0\0" + framed(samples) + framed(samples))
    put("serial_framing", "mixed", b"\7noise\0" + framed(state) + b"\5damaged\0" + framed(samples))
    put("serial_framing", "configure", b"\1" + b"\x11\x01" + struct.pack("<I", 500))
    put("serial_framing", "bare-samples", b"\1" + samples)


def scene():
    put("scene", "hdrp", (ROOT / "fixtures/scenes/hdrp.textproto").read_text())
    put("scene", "empty", "")
    put("scene", "comment", "# nothing yet\nrenderer: SCENE_RENDERER_HDRP\n")


def job_log():
    line = ('{{"sequence":{0},"job":{{"name":"jobs/000001","requestId":"a","state":"{1}",'
            '"progress":{2},"lastSequence":{0},"createTime":"2024-05-01T10:00:00Z"}}}}\n')
    put("job_log", "queued", line.format(1, "JOB_STATE_QUEUED", 0))
    whole = line.format(1, "JOB_STATE_QUEUED", 0) + line.format(2, "JOB_STATE_RUNNING", 0.5)
    put("job_log", "running", whole)
    put("job_log", "torn", whole + '{"sequence":3,"jo')


for make in (requests, list_recordings, rig_and_plan, manifest, frame_records, cube, strip,
             index_csv, serial_framing, scene, job_log):
    make()
