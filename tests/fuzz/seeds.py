#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the seed corpus of fuzz_scene: seeds.py FOLDER."""
import json
import os
import struct
import sys
import zlib


def floats(*v):
    return struct.pack('<%df' % len(v), *v)


def png(width, height):
    def chunk(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    rows = b''.join(b'\0' + bytes(4 * width) for _ in range(height))
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 6, 0, 0, 0)) +
            chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b''))


class File:
    """A glTF object and the bytes of its buffer."""

    def __init__(self):
        self.bin = b''
        self.gltf = {'asset': {'version': '2.0'}, 'bufferViews': [], 'accessors': []}

    def view(self, data, **more):
        self.bin += bytes(-len(self.bin) % 4)
        self.gltf['bufferViews'].append(
            dict(buffer=0, byteOffset=len(self.bin), byteLength=len(data), **more))
        self.bin += data
        return len(self.gltf['bufferViews']) - 1

    def accessor(self, data, component, count, kind, **more):
        self.gltf['accessors'].append(
            dict(bufferView=self.view(data), componentType=component, count=count, type=kind, **more))
        return len(self.gltf['accessors']) - 1

    def positions(self):
        return self.accessor(floats(0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5), 5126, 4, 'VEC3')

    def write(self, folder, name):
        self.gltf['buffers'] = [{'byteLength': len(self.bin)}]
        with open(os.path.join(folder, name), 'wb') as out:
            out.write(json.dumps(self.gltf, separators=(',', ':')).encode() + b'\0' + self.bin)


def meshes():
    f = File()
    position = f.positions()
    normal = f.accessor(bytes([0, 0, 127, 0] * 4)[:12], 5120, 4, 'VEC3', normalized=True)
    uv = f.accessor(struct.pack('<8H', *range(0, 65536, 8192)), 5123, 4, 'VEC2', normalized=True)
    color = f.accessor(bytes(range(16)), 5121, 4, 'VEC4', normalized=True)
    index = f.accessor(struct.pack('<6H', 0, 1, 2, 2, 1, 3), 5123, 6, 'SCALAR')
    strip = f.accessor(bytes([0, 1, 2, 3]), 5121, 4, 'SCALAR')
    attributes = {'POSITION': position, 'NORMAL': normal, 'TEXCOORD_0': uv, 'COLOR_0': color}
    f.gltf['meshes'] = [{'primitives': [
        {'attributes': attributes, 'indices': index},
        {'attributes': {'POSITION': position, 'TEXCOORD_1': uv}, 'indices': strip, 'mode': 5},
        {'attributes': {'POSITION': position}, 'indices': strip, 'mode': 6},
        {'attributes': {'POSITION': position}, 'mode': 1}]}]
    f.gltf['nodes'] = [{'mesh': 0, 'children': [1], 'scale': [1, -1, 1]},
                       {'mesh': 0, 'matrix': [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 1]}]
    f.gltf['scenes'] = [{'nodes': [0]}]
    f.gltf['scene'] = 0
    return f


def sparse():
    f = File()
    position = f.positions()
    f.gltf['accessors'][position]['sparse'] = {
        'count': 2, 'indices': {'bufferView': f.view(bytes([1, 3])), 'componentType': 5121},
        'values': {'bufferView': f.view(floats(1, 2, 3, 4, 5, 6))}}
    morph = f.accessor(floats(*range(12)), 5126, 4, 'VEC3')
    f.gltf['meshes'] = [{'weights': [0.5], 'primitives': [
        {'attributes': {'POSITION': position}, 'mode': 5, 'targets': [{'POSITION': morph}]}]}]
    f.gltf['nodes'] = [{'mesh': 0}, {'mesh': 0, 'weights': [1]}]
    return f


def looks():
    f = File()
    position = f.positions()
    image = f.view(png(3, 2))
    transform = {'KHR_texture_transform': {'offset': [0.5, 1], 'rotation': 1, 'scale': [2, 3], 'texCoord': 1}}
    f.gltf.update({
        'extensionsUsed': ['KHR_texture_transform'],
        'images': [{'bufferView': image, 'mimeType': 'image/png'}],
        'samplers': [{'magFilter': 9728, 'wrapS': 33071, 'wrapT': 33648}],
        'textures': [{'source': 0, 'sampler': 0}, {'source': 0}],
        'materials': [
            {'name': 'm', 'alphaMode': 'MASK', 'alphaCutoff': 0.25, 'doubleSided': True,
             'emissiveFactor': [1, 0.5, 0], 'emissiveTexture': {'index': 1},
             'extensions': {'KHR_materials_emissive_strength': {'emissiveStrength': 9}},
             'pbrMetallicRoughness': {
                 'baseColorFactor': [1, 1, 1, 1], 'metallicFactor': 0.5, 'roughnessFactor': 0.5,
                 'baseColorTexture': {'index': 0, 'texCoord': 1, 'extensions': transform},
                 'metallicRoughnessTexture': {'index': 0}}},
            {'alphaMode': 'BLEND', 'extensions': {'KHR_materials_unlit': {}}}],
        'meshes': [{'primitives': [{'attributes': {'POSITION': position}, 'mode': 5, 'material': 0}]}],
        'nodes': [{'mesh': 0}]})
    return f


def lights():
    f = File()
    kinds = [{'type': 'point', 'range': 3, 'intensity': 5}, {'type': 'directional', 'color': [1, 0, 0]},
             {'type': 'spot', 'spot': {'innerConeAngle': 0.1, 'outerConeAngle': 0.5},
              'extras': {'profile': 'cosine'}}]
    f.gltf['extensions'] = {'KHR_lights_punctual': {'lights': kinds}}
    f.gltf['cameras'] = [
        {'type': 'perspective', 'perspective': {'yfov': 1, 'znear': 0.1, 'zfar': 9}},
        {'type': 'orthographic', 'orthographic': {'xmag': 1, 'ymag': 2, 'znear': 0, 'zfar': 5}}]
    f.gltf['nodes'] = [{'extensions': {'KHR_lights_punctual': {'light': i}}, 'rotation': [0, 0.6, 0, 0.8]}
                       for i in range(3)] + [{'camera': 0}, {'camera': 1}]
    return f


def animated():
    f = File()
    position = f.positions()
    times = f.accessor(floats(0, 1), 5126, 2, 'SCALAR')
    moves = f.accessor(floats(0, 0, 0, 1, 2, 3), 5126, 2, 'VEC3')
    turns = f.accessor(floats(0, 0, 0, 1, 0, 1, 0, 0), 5126, 2, 'VEC4')
    cubic = f.accessor(floats(*range(18)), 5126, 6, 'VEC3')
    joints = f.accessor(bytes([0, 1, 0, 0] * 4), 5121, 4, 'VEC4')
    weights = f.accessor(floats(*[0.5, 0.5, 0, 0] * 4), 5126, 4, 'VEC4')
    bind = f.accessor(floats(*[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] * 2), 5126, 2, 'MAT4')
    f.gltf['meshes'] = [{'primitives': [
        {'attributes': {'POSITION': position, 'JOINTS_0': joints, 'WEIGHTS_0': weights}, 'mode': 5}]}]
    f.gltf['skins'] = [{'joints': [1, 2], 'inverseBindMatrices': bind}]
    f.gltf['nodes'] = [{'mesh': 0, 'skin': 0}, {'children': [2]}, {}]
    f.gltf['animations'] = [{
        'samplers': [{'input': times, 'output': moves},
                     {'input': times, 'output': turns, 'interpolation': 'STEP'},
                     {'input': times, 'output': cubic, 'interpolation': 'CUBICSPLINE'}],
        'channels': [{'sampler': 0, 'target': {'node': 0, 'path': 'translation'}},
                     {'sampler': 1, 'target': {'node': 1, 'path': 'rotation'}},
                     {'sampler': 2, 'target': {'node': 2, 'path': 'scale'}}]}]
    return f


def main():
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    for make in (meshes, sparse, looks, lights, animated):
        make().write(folder, make.__name__)
    text = json.dumps({'asset': {'version': '2.0'}, 'nodes': [{'children': [1]}, {}],
                       'buffers': [{'byteLength': 3, 'uri': 'data:application/octet-stream;base64,AAAA'}]})
    with open(os.path.join(folder, 'text'), 'w') as out:
        out.write(text)
    text += ' ' * (-len(text) % 4)
    with open(os.path.join(folder, 'container'), 'wb') as out:
        out.write(struct.pack('<4sIIII', b'glTF', 2, 20 + len(text), len(text), 0x4e4f534a) + text.encode())


main()
