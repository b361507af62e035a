fn bits_reversed(number: u32) -> u32 {
    var x = (number >> 16u) | (number << 16u);
    x = ((x & 0xff00ff00u) >> 8u) | ((x & 0x00ff00ffu) << 8u);
    x = ((x & 0xf0f0f0f0u) >> 4u) | ((x & 0x0f0f0f0fu) << 4u);
    x = ((x & 0xccccccccu) >> 2u) | ((x & 0x33333333u) << 2u);
    return ((x & 0xaaaaaaaau) >> 1u) | ((x & 0x55555555u) << 1u);
}
