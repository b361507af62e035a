//! Fair distribution of space: small items get all they need, and large items share the rest.

/// The maximum size that makes all items fit into `room`; items below it keep their size.
pub(super) fn shared(sizes: &[f32], room: f32) -> f32 {
    let mut sorted = sizes.to_vec();
    sorted.sort_by(f32::total_cmp);
    let mut left = room;
    for (i, size) in sorted.iter().enumerate() {
        let fair = left / (sorted.len() - i) as f32;
        if *size > fair {
            return fair;
        }
        left -= size;
    }
    f32::INFINITY
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_ones_share_what_small_ones_leave() {
        assert_eq!(shared(&[10.0, 20.0], 30.0), f32::INFINITY, "all fit");
        assert_eq!(shared(&[100.0, 10.0], 30.0), 20.0);
        assert_eq!(shared(&[100.0, 10.0, 50.0], 70.0), 30.0);
        assert_eq!(shared(&[100.0, 100.0], 30.0), 15.0);
    }
}
