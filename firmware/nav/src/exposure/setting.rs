//! Shutter and gain for a wanted exposure.

use super::{Exposure, ExposureParameters};

/// The setting whose product of lines and gain is nearest to `product`, as far as the limits go.
///
/// Shutter first, because gain amplifies noise as well:
///
/// - Below one period of the lamps' flicker all of it, in whole lines; a gain below 1 + 1/lines makes
///   up for the fraction of a line, which is half the exposure at two lines.
/// - Above it as many whole periods as fit, which average the flicker out, and gain for the rest.
/// - More than whole periods only where the gain is at its ceiling.
///
/// The gain comes in steps, of 8 % near 16; lines take the remainder.
pub(super) fn setting(parameters: &ExposureParameters, product: f32) -> Exposure {
    let p = parameters;
    let [shortest, longest] = [p.shutter_min_lines, p.shutter_max_lines].map(f32::from);
    let product = product.max(shortest).min(longest * p.gain_max);
    let within = |lines: f32| lines.max(shortest).min(longest);

    let period = 1.0 / (p.flicker_hz * p.line_time_s);
    let periods = libm::floorf(product.min(longest) / period);
    let lines = if periods >= 1.0 {
        within(libm::roundf(periods * period))
    } else {
        within(libm::floorf(product))
    };
    let gain = gain_step(parameters, product, lines);
    Exposure {
        // Inside u16: both limits are.
        shutter_lines: within(libm::roundf(product / gain)) as u16,
        gain,
    }
}

/// The sensor's gain that is nearest to what `lines` lack of `product`; the next higher one where the
/// lines that it lacks itself would be more than there are.
fn gain_step(parameters: &ExposureParameters, product: f32, lines: f32) -> f32 {
    let unity = f32::from(parameters.gain_unity_code);
    let longest = f32::from(parameters.shutter_max_lines);
    let code = libm::roundf(unity * lines / product);
    let code = code.min(libm::floorf(unity * longest / product));
    let highest = libm::ceilf(unity / parameters.gain_max).max(1.0);
    unity / code.max(highest).min(unity)
}
