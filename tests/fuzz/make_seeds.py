#!/usr/bin/env python3
"""Writes the seeds of the fuzz harnesses: small files of every kind that the readers accept. python3 make_seeds.py"""
import gzip
import math
import pathlib
import struct
import zlib

here = pathlib.Path(__file__).parent / "seeds"


def put(reader, name, content):
    folder = here / reader
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())


def valid_cells(h, d, p):
    count = 0
    for i in range(h):
        theta_h = ((i + 0.5) / h) ** 2 * math.pi / 2
        for j in range(d):
            theta_d = (j + 0.5) / d * math.pi / 2
            for k in range(p):
                phi = abs(math.cos((k + 0.5) / p * math.pi))
                smaller = math.cos(theta_h) * math.cos(theta_d) - math.sin(theta_h) * math.sin(theta_d) * phi
                count += smaller > 1e-9
    return count


def text(of):
    return struct.pack("<I", len(of)) + of.encode()


def checked(magic, payload):
    return magic + struct.pack("<IQI", 1, len(payload), zlib.crc32(payload)) + zlib.compress(payload, 9)


def svbrdf_map(rows, columns, band_rows, n, k, r):
    own = struct.pack("<6IId", rows, columns, band_rows, n, k, r, 7, 2.5) + text("made up")
    own += struct.pack("<6d", 0.0, 0.0, 1.0, 0.6, 0.0, 0.8) * n
    own += struct.pack(f"<{k * r}f", *(0.1 * i for i in range(k * r)))
    own += bytes(-(20 + len(own) + 4) % 64)
    out = b"gonio-svbrdf" + struct.pack("<II", 1, len(own) + 4) + own
    out += struct.pack("<I", zlib.crc32(out))
    for first in range(0, rows, band_rows):
        texels = min(band_rows, rows - first) * columns
        band = bytes(i % 60 for i in range(2 * texels * (3 * r + 2)))
        out += band + struct.pack("<I", zlib.crc32(band))
    return out


def prior(h, d, p, k, m):
    cells = valid_cells(h, d, p)
    out = struct.pack("<4IdIId", h, d, p, 0, 0.0, k, m, 0.99) + text("made up")
    out += b"".join(text(f"m{i}") for i in range(m)) + struct.pack(f"<{k}d", *range(k, 0, -1))
    out += struct.pack(f"<{3 * m * k}f", *(0.1 * i for i in range(3 * m * k)))
    for low, step in ((-3.0, 1e-4), (0.5, 1e-3)):
        out += struct.pack("<ff", low, step) + bytes(i % 3 for i in range(cells)) + bytes(i % 7 for i in range(cells))
    for i in range(k):
        out += struct.pack("<ff", -1.0, 0.01) + bytes((i + c) % 5 for c in range(cells))
    return out


def shapes(p, k, m):
    triangles = [v for t in range(p - 2) for v in (0, t + 1, t + 2)]
    out = struct.pack("<4Id", p, p - 2, k, m, 0.9) + text("made up") + b"".join(text(f"s{i}") for i in range(m))
    out += struct.pack(f"<{len(triangles)}i", *triangles) + struct.pack(f"<{k}d", *range(k, 0, -1))
    out += struct.pack(f"<{m * k}f", *(0.1 * i for i in range(m * k)))
    points = [c for v in range(p) for c in (math.cos(v), math.sin(v), 0.1 * v)]
    return out + struct.pack(f"<{3 * p}f", *points) + struct.pack(f"<{3 * p * k}f", *(0.01 * i for i in range(3 * p * k)))


def merl(h, d, p):
    return struct.pack("<3i", h, d, p) + struct.pack(f"<{3 * h * d * p}d", *(float(i % 9) for i in range(3 * h * d * p)))


def npy(values, shape, descr="<f4", version=1):
    dictionary = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}\n"
    length = struct.pack("<H" if version == 1 else "<I", len(dictionary))
    code = {"2": "e", "4": "f", "8": "d"}[descr[-1]]
    return b"\x93NUMPY" + bytes([version, 0]) + length + dictionary.encode() + struct.pack(f"<{len(values)}{code}", *values)


def mbsdf_block(ident, channels, polar, azimuth):
    count = channels * polar * polar * azimuth
    head = f"MBSDF_DATA{ident}=\n".encode() + struct.pack("<3I", channels // 3, polar, azimuth)
    return head + struct.pack(f"<{count}f", *(0.1 * (i % 7) for i in range(count)))


def tensor_file(arrays):
    """arrays: name -> (code of the type, shape, bytes)"""
    position = 18 + sum(13 + len(name) + 8 * len(shape) for name, (_, shape, _) in arrays.items())
    head, body = b"tensor_file\0\1\0" + struct.pack("<I", len(arrays)), b""
    for name, (code, shape, data) in arrays.items():
        head += struct.pack("<H", len(name)) + name.encode() + struct.pack("<HBQ", len(shape), code, position + len(body))
        head += struct.pack(f"<{len(shape)}Q", *shape)
        body += data
    return head + body


def rgl(azimuths, wavelengths=0):
    def numbers(*shape):
        return 10, shape, struct.pack(f"<{math.prod(shape)}f", *(0.1 * (i % 7 + 1) for i in range(math.prod(shape))))

    angles = 10, (2,), struct.pack("<2f", 0.0, 1.5707964)
    arrays = {"description": (1, (5,), b"paint"), "phi_i": numbers(azimuths), "theta_i": angles, "ndf": numbers(2, 3),
              "sigma": numbers(2, 3), "vndf": numbers(azimuths, 2, 3, 4)}
    if not wavelengths:
        return tensor_file({**arrays, "rgb": numbers(azimuths, 2, 3, 2, 2)})
    bands = 10, (wavelengths,), struct.pack(f"<{wavelengths}f", *(400.0 + 50.0 * i for i in range(wavelengths)))
    return tensor_file({**arrays, "wavelengths": bands, "spectra": numbers(azimuths, 2, wavelengths, 2, 2),
                        "jacobian": (1, (1,), b"\1")})


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(columns, rows, depth, kind, channels, interlaced=0, extra=b"", filter=1):
    row = (columns * channels * depth + 7) // 8
    raw = b"".join(bytes([(filter + r) % 5]) + bytes((7 * r + c) % 256 for c in range(row)) for r in range(rows))
    if interlaced:  # one pixel: the first pass alone
        raw = b"\0" + bytes(row)
    head = struct.pack(">IIBBBBB", columns, rows, depth, kind, 0, 0, interlaced)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + extra + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b"")


def exr(columns, rows):
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<I", len(value)) + value

    window = struct.pack("<4i", 0, 0, columns - 1, rows - 1)
    channels = b"".join(c + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for c in (b"B", b"G", b"R")) + b"\0"
    head = struct.pack("<II", 20000630, 2) + attribute("channels", "chlist", channels)
    head += attribute("compression", "compression", b"\0") + attribute("dataWindow", "box2i", window)
    head += attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", b"\0")
    head += attribute("pixelAspectRatio", "float", struct.pack("<f", 1)) + attribute("screenWindowCenter", "v2f", bytes(8))
    head += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    line = struct.pack(f"<{3 * columns}f", *(0.1 * i for i in range(3 * columns)))
    begin = len(head) + 8 * rows
    offsets = b"".join(struct.pack("<Q", begin + (8 + len(line)) * row) for row in range(rows))
    return head + offsets + b"".join(struct.pack("<iI", row, len(line)) + line for row in range(rows))


def directory(tags):
    return struct.pack("<H", len(tags)) + b"".join(struct.pack("<HHII", *tag) for tag in tags) + bytes(4)


def tiff(columns, rows, bits, channels, meaning):
    pixels = bytes(i % 251 for i in range(columns * rows * channels * bits // 8))
    depths, exif = 8 + len(pixels), 8 + len(pixels) + 8
    time = directory([(33434, 5, 1, exif + 18)]) + struct.pack("<II", 1, 250)
    tags = [(256, 4, 1, columns), (257, 4, 1, rows), (258, 3, channels, depths if channels > 2 else bits)]
    tags += [(259, 3, 1, 1), (262, 3, 1, meaning), (273, 4, 1, 8), (277, 3, 1, channels), (278, 4, 1, rows)]
    tags += [(279, 4, 1, len(pixels)), (34665, 4, 1, exif)]
    head = b"II*\0" + struct.pack("<I", exif + len(time))
    return head + pixels + struct.pack("<4H", *[bits] * 4) + time + directory(tags)


def jpeg(seconds):
    exif = b"II*\0" + struct.pack("<I", 8) + directory([(34665, 4, 1, 26)])
    exif += directory([(33434, 5, 1, 44)]) + struct.pack("<II", *seconds)
    return b"\xFF\xD8\xFF\xE1" + struct.pack(">H", len(exif) + 8) + b"Exif\0\0" + exif + b"\xFF\xD9"


put("utia", "float", struct.pack("<108f", *[0.1 * i for i in range(108)]))
put("utia", "double", struct.pack("<108d", *[0.1 * i for i in range(108)]))
put("merl", "small", merl(3, 2, 4))
put("merl", "small.gz", gzip.compress(merl(3, 2, 4), mtime=0))
put("merl", "marked", struct.pack("<3i", 2, 2, 2) + struct.pack("<24d", *([1.0] * 7 + [-1.0]) * 3))
put("gzip", "text.gz", gzip.compress(b"one, two, three, three, three, three", mtime=0))
put("gzip", "two.gz", gzip.compress(b"one", mtime=0) + gzip.compress(b"two", mtime=0))
put("gzip", "zlib", struct.pack("<H", 300) + zlib.compress(bytes(300)))
put("gzip", "stored", struct.pack("<H", 5) + zlib.compress(b"plain", 0))
for extents, k, m in (((2, 2, 2), 1, 1), ((3, 4, 5), 3, 2)):
    put("prior", f"payload-{k}", prior(*extents, k, m))
    put("prior", f"whole-{k}.prior", checked(b"gonio-pca", prior(*extents, k, m)))
halves = [prior(2, 2, 2, k, 1) for k in (1, 2)]
put("prior", "split", b"gonio-split" + struct.pack("<d", 0.5) + b"".join(struct.pack("<Q", len(h)) + h for h in halves))
for p, k, m in ((3, 1, 1), (6, 2, 3)):
    put("shape_model", f"payload-{k}", shapes(p, k, m))
    put("shape_model", f"whole-{k}.shapes", checked(b"gonio-shapes", shapes(p, k, m)))
put("npy", "one.npy", npy([1, 2, 3], "(3,)"))
put("npy", "two.npy", npy([1, 2, 3, 4], "(2, 2)", "<f8"))
put("npy", "three.npy", npy([1, 2], "(1, 2, 1)", "<f4", 2))
put("npy", "none.npy", npy([], "(0, 5)", "<f8", 3))
put("networks", "one", b"red paint\n\0" + npy([0.01 * (i % 50) for i in range(675)], "(1, 675)"))
put("networks", "two", b"red\n blue \n\0" + npy([0.0] * 1350, "(2, 675)", "<f8"))
put("rgl", "one.bsdf", rgl(1))
put("rgl", "two.bsdf", rgl(2))
put("rgl", "spectra.bsdf", rgl(1, 4))
put("samples", "half.csv", "theta_h,theta_d,phi_d,r,g,b,weight\n1,2,3,0.1,0.2,0.3,1\n# a comment\n40, 30, -170, 1e-3,+2,-0.5,0\n")
put("samples", "angles.csv", "theta_i,phi_i,theta_o,phi_o,r,g,b\n10,20,30,40,1,1,1\n-45,0,45,360,.5,.5,.5\n")
put("samples", "vectors.csv", "r,g,b,wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n1,1,1,0,0,1,0.6,0,0.8\n")
put("samples", "german.csv", "# Instrument: GON\n# quantity: percent\n\"Theta In [deg]\";Phi In;theta_out;phi_s;value;wavelength [nm];\"a \"\"b\"\"\"\n1,5;0;\"2,5\";180;31,4;633;x\n;;;;;;\n45;0;45;180;1,25e1;633;\n")
put("samples", "in-plane.tsv", "theta_i_rad\ttheta_o (rad)\tvalue\tquantity\r\n0.5\t-0.5\t12%\tpercent\r\n0.5\t0.25\t1.5 %\tpercent\t\r\n")
put("samples", "blanks.txt", "theta_h theta_d  phi_d brdf\n 1 2.5\t3 0.1 \n\"1\" 2 3 0.2\n")
put("samples", "directions.csv", "\ufefftheta_i,phi_i,theta_o,phi_o\r\n89.9999999,0,-89.9999989,0\r\n")
put("samples", "spectra.csv", "# quantity: brdf\ntheta_i,phi_i,theta_o,phi_o,400nm,w500,600,weight\n10,20,30,40,1,.5,-.5,1\n45,0,45,180,0,1e3,2,.5\n")
put("samples", "laser.csv", "# quantity: percent\ntheta_h;theta_d;phi_d;632,8 [nm]\n10;20;30;31,4\n")
put("samples", "matrix.csv", "# quantity: percent\ntheta_o;0\u00b0;30\u00b0\n-45;12,5;\n45;1;2\n")
put("samples", "corner.tsv", "Run\t7\ntheta_i \\ theta_o\t-10\ttheta_o=22.5\n30\t1 %\t2 %\n")
put("samples", "stated.csv", "Einfallswinkel: 30\n# quantity: brdf\ntheta_o;400nm;500nm\n-45;1;2\n")
put("samples", "tristimulus.csv", "theta_i;theta_o;X;Y;Z\n30;-30;19,56;11,87;3,97\n")
put("cornell", "small.brdf", "# paint\n3\n400 550\n700\n0.1 0.2 0.3 0.4 1 2 3\n1.5 -6.28 0 0 0.1 0.1 0.1\n")
zemax = "# made up\nSource Measured\nSymmetry PlaneSymmetrical\nSpectralContent %s\nScatterType BRDF\nSampleRotation 1\n0\nAngleOfIncidence 2\n0 40\nScatterAzimuth 2\n0 180\nScatterRadial 2\n0 30\n\n"
blocks = "%s\nDataBegin\nTIS 0.5\n1 2\n3 4\nTIS 0.5\n5 6\n7 8.5e-1\nDataEnd\n"
put("zemax_bsdf", "grey.bsdf", zemax % "Monochrome" + blocks % "Monochrome")
put("zemax_bsdf", "colour.bsdf", zemax % "XYZ" + "".join(blocks % f"Tristimulus{axis}" for axis in "XYZ"))
for name, columns, row in (("rgb", "R,G,B", "1,2,-3"), ("spectrum", "450nm,550nm,650nm", ".1,.2,.4"), ("grey", "BRDF", "1e-3")):
    put("astm_e1392", name + ".astm", f"SAMPLE made up\nNUM_POINTS 1\nVARS theta_i,phi_i,theta_s,phi_s,{columns}\n0.5,0,0.25,3.1,{row}\n")
alta = "#DIM %d %d\n#PARAM_IN %s\n#PARAM_OUT %s\n#VS 0\n"
put("alta", "difference.alta", alta % (3, 1, "ISOTROPIC_TV_TL_DPHI", "INV_STERADIAN") + "0.25 0.5 3.1 .1\n0.5 0.5 0 .2 .1 .3\n")
put("alta", "half.alta", alta % (3, 3, "RUSIN_TH_TD_PD", "RGB_COLOR") + "0.25 0.5 1 .1 .2 .3\n")
put("alta", "vectors.alta", alta % (6, 1, "CARTESIAN", "INV_STERADIAN_COSINE_FACTOR") + "0 0 1 .6 0 .8 1\n")
klems = "<WindowElement><DataDefinition><IncidentDataStructure>%s</IncidentDataStructure><AngleBasis><AngleBasisName>k</AngleBasisName><AngleBasisBlock><Theta>40</Theta><nPhis>2</nPhis></AngleBasisBlock></AngleBasis></DataDefinition><WavelengthData><Wavelength>Visible</Wavelength><WavelengthDataBlock><WavelengthDataDirection>Reflection %s</WavelengthDataDirection><ColumnAngleBasis>k</ColumnAngleBasis><RowAngleBasis>k</RowAngleBasis><ScatteringData>\n1, 2\n3, 4</ScatteringData></WavelengthDataBlock></WavelengthData></WindowElement>\n"
put("klems_xml", "front.xml", klems % ("Columns", "Front"))
put("klems_xml", "back.xml", klems % ("Rows", "Back"))
tree = "<WindowElement><DataDefinition><IncidentDataStructure>TensorTree%d</IncidentDataStructure></DataDefinition><WavelengthData><Wavelength>Visible</Wavelength><WavelengthDataBlock><WavelengthDataDirection>Reflection %s</WavelengthDataDirection><AngleBasis>LBNL/Shirley-Chiu</AngleBasis><ScatteringData>\n%s\n</ScatteringData></WavelengthDataBlock></WavelengthData></WindowElement>\n"
put("tensor_tree_xml", "three.xml", tree % (3, "Back", "{ { 0 1 2 3, 4, 5, 6, 7 }\n" + 7 * "{ 0.5 }\n" + "}"))
put("tensor_tree_xml", "four.xml", tree % (4, "Front", "{ " + " ".join(map(str, range(16))) + " }"))
speos = "OPTIS - brdf surface file v9.0\n0\nmade up\n0\n\n1\t0\n%d\n1 2\n30\n450 550\n" + 2 * "50\n2 3\n\t0 180 360\n0 1 1 1\n60 1 2 1\n"
put("speos_brdf", "brdf.brdf", speos % 1)
put("speos_brdf", "intensity.brdf", speos % 0)
put("speos_brdf", "turns.anisotropicbsdf", "OPTIS - Anisotropic BSDF surface file v11\n0\n\n0\n\n0 1 0\n1 0\n1\n2\n0 90\n1\n10\n1\n40\n20 0\nReflection Spectrum\n2\n400 42\n700 84\n" + 2 * "2 3\n\t0 180 360\n0 1 1 1\n60 1 2 1\n" + "End of file\n")
put("fred_bsdf", "black.txt", "type bsdf_data\nformat angles=deg bsdf=value scale=1\n10\t0\n0\t0\t.1\n10\t0\t.2\n")
put("fred_bsdf", "two.txt", "type bsdf_data\nformat angles=deg bsdf=value scale=1\n10 0\n10 0 .2\n50 20\n-30 110 -1e-3\n")
lighttools = "# made up\nSymmetry Asymmetric\nSpectralContent %s\nScatterAzimuth 2\n90 270\nScatterRadial 2\n0 30\nDataBegin\n%sDataEnd\n"
lit = "AOI 20\nPOI 0\nSide %s\nWavelength %s\nScatterType %s\n%sTIS 0.5\n1 2\n3 4\n"
put("lighttools_bsdf", "spectra.bsdf", lighttools % ("Monochrome", lit % ("Front", "450", "BRDF", "") + lit % ("Front", "550", "BRDF", "") + lit % ("Back", "450", "BTDF", "")))
put("lighttools_bsdf", "colour.txt", lighttools % ("XYZ", "".join(lit % ("Back", "0", "BRDF", f"TristimulusValue Tris{axis}\n") for axis in "XYZ")))
jdv = "DataType:\tBRDF(RT-300S)\t \t\rSampleID:\tmade up\t \t\rIncidence:\t%d\t \t\rPolar:\t-30,30,30\t \t\r\t\t\t\rRaw data\t\t\t\r\t-30\t0\t30\r-90\t1\t2\t3\r-80\t4\t5\t-6\r\t\t\t\r"
put("rt300s", "two.jdv", jdv % 0 + jdv % 60)
put("rt300s", "sheet.tsv", " Method\tBRDF_LD\tBRDF_LD\n Azimuth\t-90.0\t90\n Incidence\t20\t20\n Receive\t20\t-60\n L\t\t\n RT\t0.11\t-.13\n380.0\t1\t2\n")
put("rt300s", "sheet.csv", "Method;BRDF_LD\nAzimuth;0\nIncidence;22,5\nReceive;-60\nRT;0,5\n")
ssdd = "VERSION 0.3\nSOFTWARE made up\n\nDATA_TYPE brdf\nCOLOR_MODEL %s\nPARAM_TYPE %s_coordinate_system\nPARAM0_LIST 0 40\nPARAM2_LIST 0 30\nPARAM3_LIST 0 180 360\nDATA %s\n"
for kind in ("spherical", "specular", "half_difference"):
    put("ssdd", kind + ".ssdd", ssdd % ("monochrome", kind, "ascii") + "# numbers\n" + "1\n" * 12 + "DATA_TYPE specular_reflectance\nCOLOR_MODEL monochrome\nPARAM0_LIST 0\nDATA ascii\n.5\n")
put("ssdd", "binary.ssdd", (ssdd % ("rgb", "spherical", "binary")).encode() + struct.pack("<36f", *(0.1 * i for i in range(36))))
put("ssdd", "spectrum.ssdd", ssdd.replace("PARAM_TYPE", "WAVELENGTH_LIST 450 650\nPARAM_TYPE") % ("spectrum", "spherical", "ascii") + "1 2\n" * 12)


def bird(more="", **columns):
    values = {"theta_i": "30,30,0", "phi_i": "0,0,0", "theta_r": "60,60,45", "phi_r": "180,180,90", **columns}
    entries = [f'"{name}":{{"unit":"deg","values":[{v}]}}' for name, v in values.items()]
    entries.append('"BRDF":{"unit":"sr^-1","values":[0.1,0.3,0.5],"uncertainty":{"value":1,"unit":"%"}}')
    return '{"metadata":{"type":"BRDF","list":[1,true,null,"\\u00b0"]},"data":{' + ",".join(entries) + more + "}}"


put("bird", "plain.json", bird())
put("bird", "spectral.json", bird(',"wavelength_i":{"unit":"nm","values":[450,650,550]},"uBRDF":{"unit":"%","values":[1,1,2]}'))
put("bird", "polarised.json", bird(',"polarization_i":{"notation":"sp","values":["s","p",[1,0,0,0]]},"adhoc_variables":{"t":{"values":[1,1,1]}}'))
put("cornell", "two.brdf", "2\n400\n700\n0 0 0 0 0.5 0.25\n")
put("apparatus", "all.txt", "# rules\nlight 0 75\nviewer 0 80\nseparation 15 # degrees\nlight_step 7.5 0.5\nforbid 60 90 60 90\nnoise 0.02\ndark_signal 1e-4\nmisplaced 0.5\npair 45 0 20 180\n")
put("apparatus", "step.txt", "light_step 7.5\n")
put("near_field_setup", "target.txt", "size 640 480\nfocal_length 1210.5\nposition 0.5 0 0.3\ntarget 0 0 0\nlight_angles 50 180\nregion 0.1\nblock 4\nsaturation 2\n")
put("near_field_setup", "rotation.txt", "size 64 48\nfocal_length 90 91\nprincipal_point 30 20\nposition 0 0 1\nrotation 1 0 0 0 -1 0 0 0 -1\nlight 0 0.6 0.8\nirradiance 1 2 3\nwindow 1 2 30 20\nregion 0.2 0.1 0\n")
put("near_field_setup", "lamp.txt", "size 64 48\nfield_of_view 30\ndistortion -0.2 0.05 0 0\nposition 0 0.1 1\ntarget 0 0 0\nlamp 1 0 2\nintensity 3\nwhite_reflectance 0.98\nwhite_plane 0 0 0.1 0 0 1\nregion 0.2\n")
put("sphere_setup", "lamp.txt", "size 64 48\nfield_of_view 20\ndistortion -0.2 0.05 0.001 0.002 0.01\nposition 0 0 12\ntarget 0 0 0\nup 0 1 0\nlamp 3 4 5\nintensity 2\nsphere 0.5\nwhite_reflectance 0.98\nwhite_plane 0 0 -1 0 0 1\nsaturation 9\n")
put("sphere_setup", "light.txt", "size 64 48\nfocal_length 90 91\nprincipal_point 30 20\nposition 0 0 1\nrotation 1 0 0 0 -1 0 0 0 -1\nlight 0 0.6 0.8\nirradiance 1 2 3\nsphere 1\noutline 30 20 10\nsmallest_cosine 0.1\n")
put("camera_calibration", "camera.yml", "%YAML:1.0\n---\nimage_width: 64\nimage_height: 48\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 95., 0., 31.5, 0., 1.0e+02, 23.5, 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n   data: [ -0.2, 0.05,\n      0.001, 0.002, 0. ]\n")
put("camera_calibration", "camera.xml", '<?xml version="1.0"?>\n<opencv_storage>\n<image_width>64</image_width>\n<image_height>48</image_height>\n<camera_matrix type_id="opencv-matrix">\n  <rows>3</rows>\n  <cols>3</cols>\n  <dt>d</dt>\n  <data>95. 0. 31.5 0. 100. 23.5 0. 0. 1.</data></camera_matrix>\n</opencv_storage>\n')
put("exposure_times", "times.csv", "# two\nfile,seconds\na.png,0.004\nb.png, 1/250\n")
put("exposure_times", "one.csv", "file,seconds\r\na b.ppm,4e-3\r\n")
put("pnm", "rgb.ppm", b"P6\n# made up\n2 2\n255\n" + bytes(range(12)))
put("pnm", "grey16.pgm", b"P5 3 1 4095\n" + struct.pack(">3H", 0, 7, 4095))
mbsdf = b"NVIDIA ARC MBSDF V1\n"
put("mbsdf", "scalar.mbsdf", mbsdf + mbsdf_block("", 1, 2, 3))
put("mbsdf", "rgb.mbsdf", mbsdf + b'name="red \\"car\\" paint"\nnote="a\\nb"\n' + mbsdf_block("_REFLECTION", 3, 2, 2))
put("mbsdf", "both.mbsdf", mbsdf + mbsdf_block("_REFLECTION", 1, 1, 1) + mbsdf_block("_TRANSMISSION", 1, 2, 1))
xompt = '{"metadata": {"name": "x", "openMaterial3dVersion": "1.0.0"}, "brdf": {"wavelengths": [%s], "lookupTable": [%s]}}'
put("openmaterial", "lidar_brdf.xompt", xompt % ("9.05e-07", "[9.05e-07, 0.5, 0, 0, 0.02], [9.05e-07, 0.5, 0.25, 3.141593, null]"))
rows = ",\n".join(f"[{nm}e-9, 0.4, {theta}, 6.283185, 0.{nm}]" for nm in (450, 550, 650) for theta in (0, 0.5, 1.570796))
put("openmaterial", "camera_brdf.xompt", xompt % ("450e-9, 550e-9, 650e-9", rows))
put("npy", "half.npy", npy([1.0, -2.0, 65504.0], "(3,)", "<f2"))
put("exr", "small.exr", exr(3, 2))
put("exr", "one.exr", exr(1, 1))
put("tiff", "rgb16.tif", tiff(3, 2, 16, 3, 2))
put("tiff", "grey8.tif", tiff(4, 1, 8, 1, 1))
put("exif", "time.jpg", jpeg((1, 250)))
put("exif", "long.jpg", jpeg((30, 1)))
put("svbrdf_map", "small.gsv", svbrdf_map(2, 2, 1, 1, 2, 1))
put("svbrdf_map", "three-bands.gsv", svbrdf_map(5, 3, 2, 4, 6, 4))
put("scan_journal", "small.scan", "# gonio scan\nlargest_count 255\npose 0 0 1 0.6 0 0.8\npose 0 0 1 0 0.6 0.8\nreading 0 2 0.1 1 1 9 8 7 99 88 77 ?\nreading 1 1 0.5 2 1 2 3 4 5 6 ?\n")
put("scan_journal", "whole.scan", "# gonio scan\nsample 7 red paint\nsetup ? gantry, ideal\nseed 1\nlargest_count 255\nplan 1 ?\npose 0 0 1 0.6 0 0.8\nreading 0 1 0.1 1 9 8 7 ?\n")
put("scan_journal", "cut.scan", "largest_count 65535\npose 0 0 1 0.6 0 0.8\nreading 0 1 0.1 1 9 8 7 99")
palette = chunk(b"PLTE", bytes(range(12)))
put("png", "rgb.png", png(3, 4, 8, 2, 3))
put("png", "rgba16.png", png(2, 5, 16, 6, 4))
put("png", "grey1.png", png(9, 3, 1, 0, 1))
put("png", "grey16.png", png(2, 2, 16, 0, 1))
put("png", "palette2.png", png(5, 2, 2, 3, 1, extra=palette))
put("png", "alpha.png", png(2, 2, 8, 4, 2))
put("png", "interlaced.png", png(1, 1, 8, 2, 3, interlaced=1))
hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 2 +X "
put("hdr", "flat.hdr", hdr + b"3\n" + bytes(range(100, 124)))
put("hdr", "runs.hdr", hdr + b"8\n" + 2 * (bytes([2, 2, 0, 8]) + 2 * bytes([136, 65]) + bytes([8]) + bytes(range(60, 68)) + bytes([136, 130])))
ascii_ply = "ply\nformat ascii 1.0\ncomment made up\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n3 0 1 2\n4 0 1 2 3\n"
put("ply", "ascii.ply", ascii_ply)
for order, name in (("<", "little"), (">", "big")):
    head = f"ply\nformat binary_{name}_endian 1.0\nelement vertex 3\nproperty double x\nproperty float y\nproperty short z\nelement face 1\nproperty list ushort uint vertex_index\nelement edge 1\nproperty list uchar uchar a\nend_header\n"
    put("ply", f"{name}.ply", head.encode() + b"".join(struct.pack(order + "dfh", x, y, 0) for x, y in ((0, 0), (1, 0), (0, 1))) + struct.pack(order + "H3I", 3, 0, 1, 2) + bytes([2, 1, 2]))
put("obj", "small.obj", "# made up\no thing\nv 0 0 0\nv 1 0 0\nv 1 1 0 1 0.5 0.5\nv 0 1 0\nvn 0 0 1\nvt 0 0\nf 1 2 3\nf -4/1/1 -2//1 -1/1\nf 1 2 3 4\n")
frames = '{"largest_count": 4095, "window": {"column": 1, "row": 0, "columns": 2, "rows": 2}, "frames": [{"theta_i": 30, "phi_i": 0, "theta_o": 10.5, "phi_o": -180, "seconds": 0.1, "file": "a.png"}, {"theta_i": 30, "phi_i": 0, "theta_o": 10.5, "phi_o": -180, "seconds": 1, "file": "b.png"}]}'
put("recorded_frames", "manifest.json", frames)
put("recorded_frames", "one.json", '{"largest_count":1,"frames":[{"theta_i":0,"phi_i":0,"theta_o":0,"phi_o":0,"seconds":1e-3,"file":""}]}')
put("image_list", "two.json", '{"quantity": "brdf", "mask": "m.png", "invalid": "skip", "images": [{"image": "a.npy", "theta_i": 30, "phi_i": 0, "theta_o": 10.5, "phi_o": -180}, {"image": "b.exr", "theta_h": 30, "theta_d": 20, "phi_d": 45}]}')
put("image_list", "one.json", '{"quantity":"percent","invalid":"refuse","images":[{"image":"","theta_h":0,"theta_d":0,"phi_d":0}]}')
put("json", "state.json", '{"key":{"n":5,"set":"a"},"result":[1,-2.5e-3,null,true,false,"\\u00e9\\n",{"x":[]}]}')
put("json", "twice.json", '{"a":1,"b":{},"a":[18446744073709551615,-9223372036854775808,1.0]}')

words = {
    "utia": ['\\x00\\x00\\xC0\\x7F', '\\x00\\x00\\x00\\x00\\x00\\x00\\xF8\\x7F'],
    "merl": ['\\x5A\\x00\\x00\\x00', '\\xB4\\x00\\x00\\x00', '\\xFF\\xFF\\xFF\\xFF', '\\x00\\x10\\x00\\x00', '\\x1F\\x8B\\x08', '\\x00\\x00\\x00\\x00\\x00\\x00\\xF0\\xBF', '\\x00\\x00\\x00\\x00\\x00\\x00\\xF8\\x7F'],
    "gzip": ['\\x1F\\x8B\\x08', '\\x78\\x9C', '\\x78\\xDA', '\\x00\\x00\\xFF\\xFF', '\\x03\\x00'],
    "prior": ['gonio-pca', 'gonio-split', '\\x01\\x00\\x00\\x00', '\\xFF\\xFF\\xFF\\xFF', '\\x00\\x10\\x00\\x00', '\\x78\\xDA', '\\x00\\x00\\x80\\x7F', '\\x00\\x00\\xC0\\x7F'],
    "shape_model": ['gonio-shapes', '\\x01\\x00\\x00\\x00', '\\xFF\\xFF\\xFF\\xFF', '\\x00\\x00\\x00\\x80', '\\x78\\xDA', '\\x00\\x00\\x80\\x7F'],
    "npy": ['\\x93NUMPY', "'descr'", "'fortran_order'", "'shape'", "'<f2'", "'<f4'", "'<f8'", "'>f4'", 'True', 'False', '(', ')', ',', '{', '}', ':', '18446744073709551615', '\\x1B'],
    "networks": ['\\x93NUMPY', "'descr'", "'fortran_order'", "'shape'", "'<f4'", "'<f8'", '(1, 675)', '(2, 675)', '(0, 675)', '\\x0A', '\\x00', '\\x1B'],
    "samples": ['theta_h', 'theta_d', 'phi_d', 'theta_i', 'phi_i', 'theta_o', 'phi_o', 'wi_x', 'wi_y', 'wi_z', 'wo_x', 'wo_y', 'wo_z', 'weight', 'r,g,b', ',', '\\x0A', '#', '1e308', '-0', 'nan', 'inf', '89.9999999', '-89.9999989', '1e-320', '\\xEF\\xBB\\xBF', 'value', 'brdf', 'quantity', 'wavelength', 'percent', 'reflectance-factor', '# quantity: ', '# instrument: ', '[rad]', '[%]', '%', ';', '\\x09', '"', '0,5', ' ', '400nm', '[nm]', 'w500', 'lambda_600', ',700'],
    "zemax_bsdf": ['Source', 'Measured', 'Symmetry', 'SpectralContent', 'Monochrome', 'XYZ', 'TristimulusX', 'ScatterType', 'BRDF', 'SampleRotation', 'AngleOfIncidence', 'ScatterAzimuth', 'ScatterRadial', 'DataBegin', 'DataEnd', 'TIS', '1000000', '1e308', '-360', '180', 'nan', '#', '\\x0A'],
    "astm_e1392": ['NUM_POINTS', 'VARS ', 'theta_i,phi_i,theta_s,phi_s,', 'R,G,B', 'X,Y,Z', '400nm', '700nm', 'BRDF', '1.5707', '6.2831', '1e308', 'nan', '#', ',', '\\x0A'],
    "alta": ['#DIM ', '#PARAM_IN ', '#PARAM_OUT ', '#VS ', '#FORMAT ', 'RUSIN_TH_TD_PD', 'RUSIN_TH_PH_TD_PD', 'SPHERICAL_TL_PL_TV_PV', 'ISOTROPIC_TV_TL_DPHI', 'ISOTROPIC_TL_TV_PROJ_DPHI', 'CARTESIAN', 'INV_STERADIAN', 'INV_STERADIAN_COSINE_FACTOR', 'RGB_COLOR', 'XYZ_COLOR', '1.5707', '6.2831', '1e308', 'nan', '#', '\\x0A'],
    "klems_xml": ['<WindowElement>', '<DataDefinition>', '</DataDefinition>', '<IncidentDataStructure>', 'Columns', 'Rows', 'TensorTree3', '<AngleBasis>', '</AngleBasis>', '<AngleBasisName>', '<AngleBasisBlock>', '</AngleBasisBlock>', '<Theta>', '</Theta>', '<nPhis>', '</nPhis>', '<WavelengthData>', '<Wavelength>', 'Visible', '<WavelengthDataBlock>', '</WavelengthDataBlock>', '<WavelengthDataDirection>', 'Reflection Front', '<ColumnAngleBasis>', '<RowAngleBasis>', '<ScatteringData>', '</ScatteringData>', '<!--', '-->', '/>', '4096', '1e308', 'nan'],
    "tensor_tree_xml": ['<WindowElement>', '<DataDefinition>', '</DataDefinition>', '<IncidentDataStructure>', 'TensorTree3', 'TensorTree4', '<WavelengthData>', '<Wavelength>', 'Visible', '<WavelengthDataBlock>', '</WavelengthDataBlock>', '<WavelengthDataDirection>', 'Reflection Front', 'Reflection Back', '<AngleBasis>', 'LBNL/Shirley-Chiu', '<ScatteringData>', '</ScatteringData>', '<!--', '-->', '/>', '{', '}', '{ 0.5 }', '{ 0 1 2 3 4 5 6 7 }', '{ {', '} }', '1e308', 'nan'],
    "speos_brdf": ['OPTIS - brdf surface file', 'OPTIS - Anisotropic BSDF surface file', 'End of file', '\\x0A0\\x0A', '1\\x090', '90', '180', '360', '100', '1e308', 'nan', '\\x09', '\\x0A', '#', '10000'],
    "fred_bsdf": ['type bsdf_data', 'format angles=deg bsdf=value scale=1', '90', '360', '1e308', 'nan', '\\x09', '\\x0A', '#'],
    "lighttools_bsdf": ['Symmetry', 'SpectralContent', 'Monochrome', 'XYZ', 'ScatterAzimuth', 'ScatterRadial', 'DataBegin', 'DataEnd', 'AOI', 'POI', 'Side', 'Front', 'Back', 'Wavelength', 'ScatterType', 'BRDF', 'BTDF', 'TristimulusValue', 'TrisX', 'TrisY', 'TrisZ', 'TIS', '1000000', '1e308', 'nan', '-360', '#', '\\x0A'],
    "rt300s": ['DataType:', 'BRDF(RT-300S)', 'Incidence:', 'Raw data', 'Method', 'BRDF_LD', 'Azimuth', 'Incidence', 'Receive', 'RT', '90', '-90', '1e308', 'nan', '\\x09', '\\x0D', '\\x0A', ';', '0,5'],
    "ssdd": ['VERSION 0.3', 'DATA_TYPE', 'brdf', 'btdf', 'specular_reflectance', 'COLOR_MODEL', 'monochrome', 'rgb', 'xyz', 'spectrum', 'WAVELENGTH_LIST', 'PARAM_TYPE', 'spherical_coordinate_system', 'specular_coordinate_system', 'half_difference_coordinate_system', 'REDUCTION_TYPE', 'PARAM0_LIST', 'PARAM1_LIST', 'PARAM2_LIST', 'PARAM3_LIST', 'PARAM4_LIST', 'DATA', 'ascii', 'binary', '1e308', '360', 'nan', '# ', '\\x0A', '\\x00\\x00\\x80\\x7F'],
    "bird": ['"metadata"', '"data"', '"theta_i"', '"phi_i"', '"theta_r"', '"phi_r"', '"BRDF"', '"uBRDF"', '"wavelength_i"', '"wavelength_r"', '"polarization_i"', '"polarization_r"', '"adhoc_variables"', '"unit"', '"values"', '"uncertainty"', '"value"', '"deg"', '"rad"', '"sr^-1"', '"%"', '"nm"', '"s"', '"p"', '"u"', '[1,-1,0,0]', '{', '}', '[', ']', ':', ',', '1e308', 'null', '\\\\u001b', '\\\\ud83d'],
    "mbsdf": ['NVIDIA ARC MBSDF V1\\x0A', 'MBSDF_DATA=\\x0A', 'MBSDF_DATA_REFLECTION=\\x0A', 'MBSDF_DATA_TRANSMISSION=\\x0A', '="', '"\\x0A', '\\x01\\x00\\x00\\x00', '\\xFF\\xFF\\xFF\\xFF', '\\x00\\x00\\x80\\x7F'],
    "openmaterial": ['"metadata"', '"openMaterial3dVersion"', '"brdf"', '"lookupTable"', '"wavelengths"', '[9.05e-07, ', '4.5e-07', '1.570796', '6.283185', '3.141593', '0.01716', 'null', '1e308', '{', '}', '[', ']', ':', ',', '\\x0A'],
    "cornell": ['400', '700', '1.5707963267948966', '6.2831853', '10000', '1e308', 'nan', '\\x0A', '#', '-0'],
    "apparatus": ['light', 'viewer', 'separation', 'light_step', 'forbid', 'pair', 'noise', 'dark_signal', 'misplaced', '#', '\\x0A', '90', '180', '-1', '1e308', 'nan'],
    "near_field_setup": ['size', 'focal_length', 'principal_point', 'position', 'target', 'up', 'rotation', 'light', 'light_angles', 'irradiance', 'lamp', 'intensity', 'field_of_view', 'distortion', 'white_reflectance', 'white_plane', 'region', 'window', 'saturation', 'block', '#', '\\x0A', '1000000', '1e308', '1e-308', '0', '-1'],
    "sphere_setup": ['size', 'focal_length', 'field_of_view', 'principal_point', 'distortion', 'position', 'target', 'up', 'rotation', 'light', 'light_angles', 'irradiance', 'lamp', 'intensity', 'sphere', 'outline', 'white_reflectance', 'white_plane', 'saturation', 'smallest_cosine', '#', '\\x0A', '1000000', '1e308', '1e-308', '0', '-1'],
    "camera_calibration": ['%YAML:1.0', '<opencv_storage>', '</opencv_storage>', 'image_width', 'image_height', 'camera_matrix', 'distortion_coefficients', '!!opencv-matrix', 'rows', 'cols', 'data', '<rows>', '</rows>', '<data>', '</data>', '[', ']', ':', '\\x0A', '1e308', '1000000', '.'],
    "exposure_times": ['file,seconds', ',', '/', '\\x0A', '#', '1e308', '1e-308', 'nan', 'inf', '0'],
    "pnm": ['P6', 'P5', '#', '\\x0A', '255', '65535', '65536', '16384', '16385', '99999'],
    "exr": ['channels', 'chlist', 'compression', 'dataWindow', 'displayWindow', 'box2i', 'lineOrder', 'tiles', 'tiledesc', 'type', 'scanlineimage', 'tiledimage', 'deepscanline', '\\x76\\x2F\\x31\\x01', '\\xFF\\xFF\\xFF\\x7F', '\\x00\\x40\\x00\\x00'],
    "tiff": ['II*\\x00', 'MM\\x00*', 'II+\\x00', '\\x00\\x01', '\\x01\\x01', '\\x02\\x01', '\\x03\\x01', '\\x06\\x01', '\\x11\\x01', '\\x15\\x01', '\\x16\\x01', '\\x17\\x01', '\\x42\\x01', '\\x69\\x87', '\\x9A\\x82', '\\x05\\x00', '\\x08\\x00', '\\xFF\\xFF\\xFF\\xFF'],
    "exif": ['\\xFF\\xD8', '\\xFF\\xE1', '\\xFF\\xE0', '\\xFF\\xDA', 'Exif\\x00\\x00', 'II*\\x00', 'MM\\x00*', '\\x69\\x87', '\\x9A\\x82', '\\x05\\x00', '\\xFF\\xFF\\xFF\\xFF'],
    "svbrdf_map": ['gonio-svbrdf', '\\x01\\x00\\x00\\x00', '\\x00\\x00\\x02\\x00', '\\xFF\\xFF\\xFF\\xFF', '\\x00\\x3C', '\\x00\\x7C'],
    "scan_journal": ['sample ', 'setup ? ', 'seed ', 'plan 1 ?', 'largest_count', 'pose', 'reading', '?', '#', '\\x0A', '65535', '0 0 1', '0.6 0 0.8', '1000', '1000000', '1e9', 'nan'],
    "png": ['\\x89PNG\\x0D\\x0A\\x1A\\x0A', 'IHDR', 'IDAT', 'IEND', 'PLTE', 'tRNS', 'gAMA', 'CgBI', '\\x00\\x00\\x40\\x00', '\\x00\\x00\\x00\\x0D', '\\x78\\x9C'],
    "hdr": ['#?RADIANCE', '#?RGBE', 'FORMAT=32-bit_rle_rgbe', 'EXPOSURE=', '-Y ', '+X ', '+Y ', '\\x0A\\x0A', '16384', '\\x02\\x02\\x00\\x08', '\\x88', '\\xFF'],
    "ply": ['ply', 'format ascii 1.0', 'format binary_little_endian 1.0', 'format binary_big_endian 1.0', 'element vertex ', 'element face ', 'property list ', 'property ', 'uchar', 'char', 'short', 'ushort', 'int', 'uint', 'float', 'double', 'int8', 'float64', 'vertex_indices', 'vertex_index', 'end_header', 'comment', 'obj_info', '\\x0A', '4294967295', '18446744073709551615', 'nan'],
    "obj": ['v ', 'f ', 'vn ', 'vt ', 'o ', 'g ', 's ', 'usemtl ', '/', '//', '-1', '9223372036854775807', '-9223372036854775808', '\\x0A', '#', 'nan', '1e308'],
    "recorded_frames": ['"largest_count"', '"window"', '"frames"', '"theta_i"', '"phi_i"', '"theta_o"', '"phi_o"', '"seconds"', '"file"', '"column"', '"row"', '"columns"', '"rows"', '{', '}', '[', ']', ':', ',', '65535', '1e308', '\\\\u001b', 'null', '89.9999999999'],
    "image_list": ['"quantity"', '"brdf"', '"brdf-cosine"', '"reflectance-factor"', '"percent"', '"mask"', '"invalid"', '"skip"', '"refuse"', '"images"', '"image"', '"theta_i"', '"phi_i"', '"theta_o"', '"phi_o"', '"theta_h"', '"theta_d"', '"phi_d"', '{', '}', '[', ']', ':', ',', '1e308', '-360', '89.9999999999', '\\\\u001b', '\\\\u0000', 'null'],
    "json": ['{', '}', '[', ']', ':', ',', '"key"', '"result"', 'null', 'true', 'false', '1e308', '1e400', '-0.0', '18446744073709551616', '\\\\u001b', '\\\\ud83d\\\\ude00', '\\\\ud800', '\\xEF\\xBB\\xBF', '""'],
}
for reader, entries in words.items():
    lines = "".join('"' + entry.replace('"', '\\"') + '"\n' for entry in entries)
    (here.parent / "dictionaries" / f"{reader}.dict").write_text(lines)
