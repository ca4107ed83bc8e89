"""Reads the subset of the pbrt-v4 format that the benchmark's scenes use, and makes a Mitsuba scene.

Both renderers get the same `Statement`s: alhazen as text by `to_pbrt`, Mitsuba as a dictionary by
`to_mitsuba`. `comparable` takes out what the two do not define alike.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

# Luminance of the CIE 1931 observer, integrated over wavelength: Mitsuba divides by it, pbrt does not.
CIE_Y_INTEGRAL = 106.856895
POSITIONAL = {"Texture": 3, "MediumInterface": 2}  # quoted words before the parameters; else 1
SILVER = {"eta": (0.14, 0.12, 0.14), "k": (4.0, 3.2, 2.4)}  # red, green and blue


@dataclass
class Statement:
    """A directive with its words or numbers, and its parameters: name -> (type, values)."""

    name: str
    words: list
    parameters: dict

    def get(self, name, default=None):
        """The only value of a parameter."""
        return self.parameters[name][1][0] if name in self.parameters else default


def read_pfm(path):
    """The colours of a file in PFM, whose rows go upwards."""
    _, size, _, values = Path(path).read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    return np.frombuffer(values, "<f4").reshape(height, width, 3)[::-1].astype(np.float64)


def parse(path):
    """The statements of a file; file names in them become absolute."""
    tokens = re.findall(r'#[^\n]*|"[^"]*"|\[|\]|[^\s\[\]"#]+', Path(path).read_text())
    tokens = [token for token in tokens if not token.startswith("#")]
    statements, at = [], 0

    def values():
        nonlocal at
        out, bracket = [], at < len(tokens) and tokens[at] == "["
        at += bracket
        while at < len(tokens) and tokens[at] != "]":
            token = tokens[at]
            if token.startswith('"'):
                out.append(token[1:-1])
            else:
                out.append({"true": True, "false": False}.get(token) if token.isalpha() else float(token))
            at += 1
            if not bracket:
                break
        at += bracket
        return out

    while at < len(tokens):
        statement = Statement(tokens[at], [], {})
        at += 1
        while at < len(tokens) and not tokens[at][0].isalpha():
            if tokens[at].startswith('"') and len(statement.words) >= POSITIONAL.get(statement.name, 1):
                kind, name = tokens[at][1:-1].split()
                at += 1
                statement.parameters[name] = (kind, values())
            else:
                statement.words += values()
        if "filename" in statement.parameters and statement.name in ("Shape", "Texture", "LightSource"):
            file = str((Path(path).parent / statement.get("filename")).resolve())
            statement.parameters["filename"] = ("string", [file])
        statements.append(statement)
    return statements


def comparable(statements):
    """Without media, which Mitsuba's `path` does not have, and with bilinear textures; coated
    surfaces, whose models differ, become diffuse ones, and metals have the same few numbers."""
    out = []
    for s in statements:
        if s.name in ("MakeNamedMedium", "MediumInterface"):
            continue
        if s.get("type") == "coateddiffuse":
            s.parameters = {"type": ("string", ["diffuse"]), "reflectance": s.parameters["reflectance"]}
        if s.get("type") == "conductor":
            for name in ("eta", "k"):
                kind, values = s.parameters[name]
                r, g, b = SILVER[name] if kind == "spectrum" else values
                s.parameters[name] = ("spectrum", [300, b, 450, b, 550, g, 630, r, 900, r])
        if s.name == "Texture" and s.words[2] == "imagemap":
            s.parameters["filter"] = ("string", ["bilinear"])
        if s.name == "Integrator":
            s.words = ["path"]
        out.append(s)
    return out


def to_pbrt(statements):
    """The text of statements."""

    def text(value):
        if isinstance(value, bool):
            return str(value).lower()
        return f'"{value}"' if isinstance(value, str) else f"{value:.9g}"

    lines = []
    for s in statements:
        words = " ".join(text(word) for word in s.words)
        lines.append(f"{s.name} [ {words} ]" if s.name == "Transform" else f"{s.name} {words}")
        for name, (kind, values) in s.parameters.items():
            numbers = [int(v) if kind == "integer" else v for v in values]
            lines.append(f'    "{kind} {name}" [ {" ".join(text(v) for v in numbers)} ]')
    return "\n".join(lines) + "\n"


def look_at(numbers):
    """pbrt's camera from world: x to the right, z forward, left-handed."""
    eye, target, up = np.reshape(numbers, (3, 3))
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(up / np.linalg.norm(up), forward)
    right /= np.linalg.norm(right)
    world_from_camera = np.eye(4)
    world_from_camera[:3, :4] = np.stack([right, np.cross(forward, right), forward, eye], 1)
    return np.linalg.inv(world_from_camera)


def to_mitsuba(statements, mi, width, height, spp, folder):
    """The dictionary of a scene for the variant that is set; meshes are written to `folder`."""
    transform, stack, light, bsdf = np.eye(4), [], None, None
    materials, textures, scene = {}, {}, {"type": "scene"}
    for s in statements:
        if s.name == "Transform":
            transform = np.reshape(s.words, (4, 4)).T
        elif s.name == "Scale":
            transform = transform @ np.diag([*s.words, 1])
        elif s.name == "LookAt":
            transform = transform @ look_at(s.words)
        elif s.name == "Integrator":
            depth = int(s.get("maxdepth")) + 1
            scene["integrator"] = {"type": "path", "max_depth": depth}
        elif s.name == "Camera":
            pose = np.linalg.inv(transform) @ np.diag([-1, 1, 1, 1])
            film = {"type": "hdrfilm", "width": width, "height": height, "pixel_format": "rgb",
                    "component_format": "float32", "rfilter": {"type": "box"}}
            scene["sensor"] = {"type": "perspective", "fov": s.get("fov"), "fov_axis": "smaller", "film": film,
                               "near_clip": 1e-3, "far_clip": 1e5, "to_world": mi.ScalarTransform4f(pose),
                               "sampler": {"type": "independent", "sample_count": spp}}
        elif s.name == "WorldBegin":
            transform = np.eye(4)
        elif s.name == "AttributeBegin":
            stack.append((transform, light, bsdf))
        elif s.name == "AttributeEnd":
            transform, light, bsdf = stack.pop()
        elif s.name == "Texture":
            textures[s.words[0]] = texture(s, mi)
        elif s.name == "LightSource":
            scene[f"light{len(scene)}"] = sky(s, mi, transform)
        elif s.name in ("MakeNamedMaterial", "Material"):
            made = material(s, textures)
            if s.name == "Material":
                bsdf = made
            else:
                materials[s.words[0]] = made
        elif s.name == "NamedMaterial":
            bsdf = materials[s.words[0]]
        elif s.name == "AreaLightSource":
            light = {"type": "area", "radiance": emission(s)}
        elif s.name == "Shape":
            name = f"shape{len(scene)}"
            scene[name] = shape(s, mi, transform, Path(folder) / f"{name}.ply") | {"bsdf": bsdf}
            if light:
                scene[name]["emitter"] = light
        elif s.name not in ("Film", "PixelFilter", "Sampler"):
            raise ValueError(f"{s.name} has no counterpart here")
    return scene


def texture(s, mi):
    """An image, or a checkerboard, of which Mitsuba counts pairs of squares."""
    if s.words[2] == "imagemap":
        return {"type": "bitmap", "filename": s.get("filename")}
    if s.words[2] != "checkerboard":
        raise ValueError(f"the texture {s.words[2]} has no counterpart here")
    scales = [s.get("uscale", 1.0) / 2, s.get("vscale", 1.0) / 2, 1]
    colors = {f"color{i}": {"type": "rgb", "value": s.parameters[f"tex{i + 1}"][1]} for i in range(2)}
    return {"type": "checkerboard", "to_uv": mi.ScalarTransform4f().scale(scales)} | colors


def sky(s, mi, transform):
    """Light from infinity: an image over longitude and latitude, of twice the resolution of the
    octahedral one, whose nearest pixels it has [Clarberg 2008]."""
    if s.words[0] != "infinite" or "filename" not in s.parameters:
        raise ValueError("only lights at infinity with an image have a counterpart here")
    pixels = read_pfm(s.get("filename")).astype(np.float32)
    size = len(pixels)
    theta = (np.arange(2 * size) + 0.5)[:, None] * np.pi / (2 * size)
    phi = (np.arange(4 * size) + 0.5)[None, :] * np.pi / (2 * size)
    world = [np.sin(phi) * np.sin(theta), np.cos(theta) + 0 * phi, -np.cos(phi) * np.sin(theta)]
    x, y, z = np.tensordot(np.linalg.inv(transform[:3, :3]), np.stack(world), 1)
    radius = np.sqrt(np.maximum(1 - np.abs(z), 0))
    v = radius * np.arctan2(np.abs(y), np.abs(x)) * 2 / np.pi
    u = radius - v
    u, v = np.where(z < 0, 1 - v, u), np.where(z < 0, 1 - u, v)
    column, row = (((np.copysign(c, sign) + 1) / 2 * size).astype(int).clip(0, size - 1) for c, sign in ((u, x), (v, y)))
    return {"type": "envmap", "bitmap": mi.Bitmap(pixels[row, column])}


def spectrum(s, name, textures):
    """A parameter of a material as a texture."""
    kind, values = s.parameters[name]
    if kind == "texture":
        return dict(textures[values[0]])
    if kind == "rgb":
        return {"type": "rgb", "value": values}
    return {"type": "spectrum", "value": pairs(values)}


def pairs(values, scale=1.0):
    """Wavelengths and values."""
    return [(wavelength, value * scale) for wavelength, value in zip(values[0::2], values[1::2])]


def emission(s):
    """Radiance of a light; a spectrum is relative, and `scale` its luminance."""
    kind, values = s.parameters["L"]
    if kind == "rgb":
        return {"type": "rgb", "value": values}
    from mitsuba import cie1931_y

    at = np.arange(360, 831)
    relative = np.interp(at, values[0::2], values[1::2], left=0, right=0)
    luminance = np.sum(relative * np.array([cie1931_y(float(x)) for x in at]).ravel())
    scale = s.get("scale", 1.0) * CIE_Y_INTEGRAL / luminance
    return {"type": "spectrum", "value": pairs(values, scale)}


def material(s, textures):
    """A BSDF; pbrt's reflect on both sides."""
    kind = s.get("type", s.words[0])
    if kind == "diffuse":
        return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": spectrum(s, "reflectance", textures)}}
    if kind == "dielectric":
        return {"type": "dielectric", "int_ior": s.get("eta"), "ext_ior": 1.0}
    if kind != "conductor":
        raise ValueError(f"the material {kind} has no counterpart here")
    alpha = s.get("uroughness", s.get("roughness", 0.0))
    rough = {"type": "roughconductor", "distribution": "ggx", "alpha": alpha} if alpha else {"type": "conductor"}
    return {"type": "twosided", "bsdf": rough | {name: spectrum(s, name, textures) for name in ("eta", "k")}}


def shape(s, mi, transform, path):
    """A shape; triangles and patches as a file at `path`."""
    to_world = mi.ScalarTransform4f(transform)
    if s.words[0] == "disk":
        return {"type": "disk", "to_world": to_world @ mi.ScalarTransform4f().scale([s.get("radius")] * 2 + [1])}
    if s.words[0] == "plymesh":
        path = Path(s.get("filename"))
        header = path.read_bytes().split(b"end_header")[0]
        return {"type": "ply", "filename": str(path), "to_world": to_world, "flip_tex_coords": True,
                "face_normals": b" nx" not in header}
    if s.words[0] == "bilinearmesh":
        indices = np.array([[0, 1, 3], [0, 3, 2]])
    elif s.words[0] == "trianglemesh":
        indices = np.reshape(s.parameters["indices"][1], (-1, 3)).astype(int)
    else:
        raise ValueError(f"the shape {s.words[0]} has no counterpart here")
    attributes = [("P", ["x", "y", "z"]), ("N", ["nx", "ny", "nz"]), ("uv", ["u", "v"])]
    attributes = [(name, columns) for name, columns in attributes if name in s.parameters]
    rows = np.concatenate([np.reshape(s.parameters[name][1], (-1, len(c))) for name, c in attributes], 1)
    with open(path, "w") as file:
        file.write(f"ply\nformat ascii 1.0\nelement vertex {len(rows)}\n")
        file.writelines(f"property float {column}\n" for _, columns in attributes for column in columns)
        file.write(f"element face {len(indices)}\nproperty list uchar int vertex_indices\nend_header\n")
        file.writelines(" ".join(f"{v:.9g}" for v in row) + "\n" for row in rows)
        file.writelines("3 " + " ".join(str(i) for i in face) + "\n" for face in indices)
    return {"type": "ply", "filename": str(path), "to_world": to_world, "flip_tex_coords": True,
            "face_normals": "N" not in s.parameters}
