//! Tokens and lengths of glTF files.

/// Keywords of the JSON, and the type of the binary chunk.
pub const WORDS: &str = "mode mesh children count byteOffset byteStride byteLength indices bufferView 5121 5123 5125 5126 VEC3 sparse \
                         uri BIN\0 extensions EXT_mesh_gpu_instancing TRANSLATION ROTATION SCALE VEC4 values doubleSided \
                         TEXCOORD_0 VEC2 textures images samplers source KHR_texture_transform";

/// Corrects the lengths in the header of a binary glTF file and in its two chunks.
pub fn repair(input: &mut [u8]) {
    let length = input.len();
    let binary = input.windows(4).position(|window| window == b"BIN\0");
    let Some(binary) = binary.filter(|at| input.starts_with(b"glTF") && *at >= 24) else {
        return;
    };
    for (at, value) in [
        (8, length),
        (12, binary - 24),
        (binary - 4, length - binary - 4),
    ] {
        input[at..at + 4].copy_from_slice(&(value as u32).to_le_bytes());
    }
}
