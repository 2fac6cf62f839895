// SPDX-License-Identifier: MIT
#include "reference_priv.h"

// Sobol's first two dimensions, Owen-scrambled by a hash and padded: each pair of dimensions is
// the same two, shuffled and scrambled on its own.
// Source: Burley. Practical Hash-based Owen Scrambling. JCGT 9(4), 2020.

static uint32_t mix(uint32_t x)
{
    x = (x ^ x >> 16) * 0x21f0aaadu;
    x = (x ^ x >> 15) * 0x735a2d97u;
    return x ^ x >> 15;
}

static uint32_t combine(uint32_t a, uint32_t b)
{
    return mix(a ^ (mix(b) + 0x9e3779b9u + (a << 6) + (a >> 2)));
}

static uint32_t reverse(uint32_t x)
{
    x = x >> 16 | x << 16;
    x = (x & 0xff00ff00u) >> 8 | (x & 0x00ff00ffu) << 8;
    x = (x & 0xf0f0f0f0u) >> 4 | (x & 0x0f0f0f0fu) << 4;
    x = (x & 0xccccccccu) >> 2 | (x & 0x33333333u) << 2;
    return (x & 0xaaaaaaaau) >> 1 | (x & 0x55555555u) << 1;
}

// Every bit is flipped or not by a hash of the bits above it: of the reversed number, a hash
// in which no bit depends on a higher one. Products by even numbers do that (Laine and Karras).
static uint32_t owen(uint32_t x, uint32_t seed)
{
    x = reverse(x);
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return reverse(x);
}

// Dimension 1: the direction numbers of the polynomial x + 1 are rows of Pascal's triangle
// modulo 2, each the one before xor itself shifted.
static uint32_t sobol_1(uint32_t index)
{
    uint32_t x = 0;
    for (uint32_t v = 1u << 31; index; index >>= 1, v ^= v >> 1)
        if (index & 1)
            x ^= v;
    return x;
}

sampler sampler_of(uint64_t seed, int x, int y)
{
    const uint32_t low = combine((uint32_t) seed, (uint32_t) (seed >> 32));
    return (sampler){ combine(combine(low, (uint32_t) x), (uint32_t) y) };
}

void sampler_pair(sampler s, uint32_t index, uint32_t pair, double out[2])
{
    const uint32_t key = combine(s.key, pair);
    const uint32_t at = owen(index, key);
    out[0] = owen(reverse(at), combine(key, 1)) * 0x1p-32;
    out[1] = owen(sobol_1(at), combine(key, 2)) * 0x1p-32;
}
