// SPDX-License-Identifier: MIT
#include "manage_priv.h"

#include <math.h>
#include <string.h>

// Indices by falling value >= 0; of equal ones the first.
static void rank(const share *shares, int count, bool by_rest, sort_entry *sorted)
{
    for (int i = 0; i < count; i++) {
        uint64_t bits; // of doubles that are not negative these rise with the value
        memcpy(&bits, by_rest ? &shares[i].rest : &shares[i].weight, sizeof bits);
        sorted[i] = (sort_entry){ .key = ~bits, .birth = (uint64_t) i, .point = i };
    }
    iir_sort(sorted, count);
}

static double part_of(const share *s, double factor)
{
    return fmin(fmax(factor * s->weight, s->low), s->high);
}

static double sum_of(const share *shares, int count, double factor)
{
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += part_of(&shares[i], factor);
    return sum;
}

// The factor of the weights that makes the parts, kept within their bounds, sum to `total`.
static double factor_of(const share *shares, int count, double total)
{
    double weight = 0, most = 0;
    for (int i = 0; i < count; i++) {
        weight += shares[i].weight;
        if (shares[i].weight > 0)
            most = fmax(most, shares[i].high / shares[i].weight);
    }
    const double plain = weight > 0 ? total / weight : 0;
    if (fabs(sum_of(shares, count, plain) - total) < 1e-9)
        return plain;
    double range[2] = { 0, most };
    for (int i = 0; i < 128; i++) {
        const double middle = 0.5 * (range[0] + range[1]);
        range[sum_of(shares, count, middle) >= total] = middle;
    }
    return range[1];
}

// One more for the largest remainders, or one less for the smallest, until `left` is used up.
static void give_rest(share *shares, int count, int left, const sort_entry *sorted)
{
    bool more = true;
    while (left > 0 && more) {
        more = false;
        for (int k = 0; k < count && left > 0; k++) {
            share *s = &shares[sorted[k].point];
            const bool take = s->part < s->high && s->weight > 0;
            s->part += take;
            left -= take;
            more = more || take;
        }
    }
    for (int k = count - 1; k >= 0 && left < 0; k--) {
        share *s = &shares[sorted[k].point];
        const bool take = s->part > s->low;
        s->part -= take;
        left += take;
    }
}

static void give_heaviest(share *shares, int count, int total, const sort_entry *sorted)
{
    for (int k = 0; k < count; k++) {
        share *s = &shares[sorted[k].point];
        s->part = s->low < total ? s->low : total;
        total -= s->part;
    }
}

void iir_share(share *shares, int count, int total, sort_entry *scratch)
{
    int low = 0;
    double high = 0;
    for (int i = 0; i < count; i++) {
        low += shares[i].low;
        high += shares[i].weight > 0 ? shares[i].high : shares[i].low;
    }
    if (low >= total) {
        rank(shares, count, false, scratch);
        give_heaviest(shares, count, total, scratch);
        return;
    }
    int left = high < total ? (int) high : total;
    const double factor = factor_of(shares, count, left);
    for (int i = 0; i < count; i++) {
        share *s = &shares[i];
        double part = part_of(s, factor);
        const bool bound = part <= s->low || part >= s->high;
        if (!bound && s->carry)
            part = fmin(fmax(part + *s->carry, s->low), s->high);
        s->part = (int) floor(part);
        s->rest = part - s->part;
        left -= s->part;
        if (s->carry)
            *s->carry = bound ? s->part : part;
    }
    rank(shares, count, true, scratch);
    give_rest(shares, count, left, scratch);
    for (int i = 0; i < count; i++)
        if (shares[i].carry)
            *shares[i].carry = fmin(fmax(*shares[i].carry - shares[i].part, -1), 1);
}
