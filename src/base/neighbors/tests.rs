//! Case K5: neighbour lists against a brute-force search.

use super::{
    Cloud, FirstOfCloud, NeighborError, NeighborList, NeighborSearch, Periodic, SupportRadii, VerletList,
};
use glam::DVec3;
use proptest::prelude::*;

/// Reproducible numbers in [0, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn point(&mut self, dim: usize) -> DVec3 {
        DVec3::new(self.next(), self.next(), if dim == 3 { self.next() } else { 0.0 })
    }
}

fn random_cloud(seed: u64, count: usize, dim: usize) -> Vec<DVec3> {
    let mut random = Random(seed);
    (0..count).map(|_| random.point(dim)).collect()
}

/// Minimum image by trying all of them, for arbitrary positions.
fn distance_squared(x_i: DVec3, x_j: DVec3, lengths: DVec3) -> f64 {
    let mut d = x_j - x_i;
    for a in 0..3 {
        while lengths[a] > 0.0 && d[a] > 0.5 * lengths[a] {
            d[a] -= lengths[a];
        }
        while lengths[a] > 0.0 && d[a] < -0.5 * lengths[a] {
            d[a] += lengths[a];
        }
    }
    d.length_squared()
}

fn support(cloud: Cloud<'_>, i: usize) -> f64 {
    match cloud.support {
        SupportRadii::Uniform(h) => h,
        SupportRadii::PerParticle(h) => h[i],
    }
}

/// Pairs whose distance equals the radius to round-off may be included or not.
fn check(list: &NeighborList, targets: Cloud<'_>, sources: Option<Cloud<'_>>, skin: f64, lengths: DVec3) {
    let others = sources.unwrap_or(targets);
    assert_eq!(list.rows(), targets.positions.len());
    for i in 0..list.rows() {
        let row = list.row(i);
        assert!(row.windows(2).all(|w| w[0] < w[1]), "row {i} is not ascending: {row:?}");
        for j in 0..others.positions.len() {
            let radius = 0.5 * (support(targets, i) + support(others, j)) + skin;
            let distance = distance_squared(targets.positions[i], others.positions[j], lengths).sqrt();
            let listed = row.binary_search(&(j as u32)).is_ok();
            if sources.is_none() && i == j {
                assert!(!listed, "particle {i} lists itself");
            } else if (distance - radius).abs() > 1e-13 * (1.0 + radius) {
                assert_eq!(listed, distance < radius, "pair {i} {j}, distance {distance}, radius {radius}");
            }
        }
    }
}

fn build(targets: Cloud<'_>, sources: Option<Cloud<'_>>, skin: f64, periodic: &Periodic) -> NeighborList {
    let mut list = NeighborList::default();
    let mut search = NeighborSearch::default();
    match sources {
        None => search.within(targets, skin, periodic, &mut list),
        Some(sources) => search.between(targets, sources, skin, periodic, &mut list),
    }
    .unwrap();
    list
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(150) })]

    #[test]
    fn random_clouds(
        seed in any::<u64>(), count in 0_usize..300, dim in 2_usize..=3, radius in 0.01_f64..1.5, skin in 0.0_f64..0.1,
        spread in 0.0_f64..1.0, others in 0_usize..100, two_sets in any::<bool>(), offset in -2.0_f64..2.0,
    ) {
        let points = random_cloud(seed, count, dim);
        let mut random = Random(seed ^ 1);
        let radii: Vec<f64> = (0..count).map(|_| radius * (1.0 - spread * random.next())).collect();
        let cloud = Cloud::per_particle(&points, &radii);
        let more: Vec<DVec3> =
            random_cloud(seed ^ 2, others, dim).into_iter().map(|x| x + DVec3::X * offset).collect();
        let sources = two_sets.then_some(Cloud::uniform(&more, 0.7 * radius));
        check(&build(cloud, sources, skin, &Periodic::NONE), cloud, sources, skin, DVec3::ZERO);
        let uniform = Cloud::uniform(&points, radius);
        check(&build(uniform, sources, skin, &Periodic::NONE), uniform, sources, skin, DVec3::ZERO);
    }

    #[test]
    fn periodic_clouds(
        seed in any::<u64>(), count in 1_usize..200, dim in 2_usize..=3, radius in 0.02_f64..0.5, skin in 0.0_f64..0.01,
        axes in any::<[bool; 3]>(), stray in 0.0_f64..3.0, two_sets in any::<bool>(),
    ) {
        let axes = [axes[0], axes[1], axes[2] && dim == 3];
        let (min, lengths) = (DVec3::new(-0.3, 0.2, 0.1), DVec3::new(1.1, 1.3, 1.2));
        let periodic = Periodic::new(min, min + lengths, axes).unwrap();
        let place = |x: DVec3| min + (x - DVec3::splat(0.5) * stray) * (1.0 + stray) * lengths;
        let points: Vec<DVec3> = random_cloud(seed, count, dim).into_iter().map(place).collect();
        let more: Vec<DVec3> = random_cloud(seed ^ 2, count / 2, dim).into_iter().map(place).collect();
        let cloud = Cloud::uniform(&points, radius);
        let sources = two_sets.then_some(Cloud::uniform(&more, radius));
        check(&build(cloud, sources, skin, &periodic), cloud, sources, skin, periodic.lengths());
    }

    #[test]
    fn few_particles_far_apart(seed in any::<u64>(), clusters in 1_usize..12, extent in 0.0_f64..12.0) {
        let mut random = Random(seed);
        let mut points = Vec::new();
        for _ in 0..clusters {
            let centre = (random.point(3) - DVec3::splat(0.5)) * 10_f64.powf(extent);
            points.extend((0..10).map(|_| centre + 0.3 * random.point(3)));
        }
        let cloud = Cloud::uniform(&points, 0.25);
        check(&build(cloud, None, 0.01, &Periodic::NONE), cloud, None, 0.01, DVec3::ZERO);
    }
}

#[test]
fn degenerate_clouds() {
    let coincident = vec![DVec3::splat(0.3); 40];
    let list = NeighborList::reference(Cloud::uniform(&coincident, 1e-3), &Periodic::NONE).unwrap();
    assert!(list.counts().all(|n| n == 39));

    let lattice: Vec<DVec3> = (0..400).map(|i| DVec3::new((i % 20) as f64, (i / 20) as f64, 0.0)).collect();
    let cloud = Cloud::uniform(&lattice, 2.0);
    let list = NeighborList::reference(cloud, &Periodic::NONE).unwrap();
    // The test is strict: particles at exactly two spacings are not neighbours.
    assert_eq!((list.max_count(), list.min_count()), (8, 3));
    let torus = Periodic::new(DVec3::ZERO, DVec3::new(20.0, 20.0, 0.0), [true, true, false]).unwrap();
    let list = NeighborList::reference(cloud, &torus).unwrap();
    assert!(list.counts().all(|n| n == 8));
    // The narrowest domains: one and a half times the radius, and then exactly the radius, on each side.
    for narrow in [6.0, 4.0] {
        let strip: Vec<DVec3> =
            (0..400).map(|i| DVec3::new((i / 4) as f64, narrow / 4.0 * (i % 4) as f64, 0.0)).collect();
        let cloud = Cloud::uniform(&strip, 2.0);
        let channel = Periodic::new(DVec3::ZERO, DVec3::new(0.0, narrow, 0.0), [false, true, false]).unwrap();
        let list = NeighborList::reference(cloud, &channel).unwrap();
        check(&list, cloud, None, 0.0, channel.lengths());
    }

    for points in [vec![], vec![DVec3::ONE]] {
        let list = NeighborList::reference(Cloud::uniform(&points, 1.0), &torus).unwrap();
        assert_eq!((list.rows(), list.pairs(), list.mean_count()), (points.len(), 0, 0.0));
    }
    let far = vec![DVec3::splat(-1e308), DVec3::splat(1e308), DVec3::ZERO, DVec3::X];
    let list = NeighborList::reference(Cloud::uniform(&far, 1.5), &Periodic::NONE).unwrap();
    assert_eq!(list.counts().collect::<Vec<_>>(), [0, 0, 1, 1]);
}

/// A diagonal wire in a box of 10^17 cells: work and memory proportional to the number of cells would not be
/// feasible.
#[test]
fn a_long_wire_is_as_cheap_as_a_block() {
    let count = 1_000_000;
    let wire: Vec<DVec3> = (0..count).map(|i| DVec3::splat(0.5 * i as f64)).collect();
    let list = NeighborList::reference(Cloud::uniform(&wire, 1.0), &Periodic::NONE).unwrap();
    assert_eq!(list.pairs(), 2 * (count - 1));
}

#[test]
fn same_bits_on_any_number_of_threads() {
    let points = random_cloud(7, 20_000, 3);
    let torus = Periodic::new(DVec3::ZERO, DVec3::ONE, [true; 3]).unwrap();
    let lists = [1, 2, 7].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| NeighborList::reference(Cloud::uniform(&points, 0.07), &torus).unwrap())
    });
    assert!(lists[0].mean_count() > 20.0);
    assert!(lists[0] == lists[1] && lists[0] == lists[2]);
}

/// The corners of cells are integer multiples of their length, and neighbours are in the order of cells even
/// where cells share buckets.
#[test]
fn the_order_of_neighbours_does_not_hang_on_who_else_is_there() {
    let near = random_cloud(5, 400, 3);
    let rows_with = |others: &[DVec3]| {
        let all: Vec<DVec3> = near.iter().chain(others).copied().collect();
        let (mut list, mut search) = (NeighborList::default(), NeighborSearch::default());
        let cloud = Cloud::uniform(&all, 0.3);
        search
            .of_first(
                FirstOfCloud { cloud, targets: near.len() },
                &[all.len() as u32],
                0.0,
                &Periodic::NONE,
                &mut list,
            )
            .expect("a list");
        (0..near.len()).map(|i| list.row(i).to_vec()).collect::<Vec<_>>()
    };
    let alone = rows_with(&[]);
    assert!(alone.iter().any(|row| !row.is_sorted()), "rows are in the order of cells");
    for far in [0.05, 0.77, 31.3, 4e3, 1e7] {
        assert_eq!(
            rows_with(&[DVec3::splat(-1.0 - far), DVec3::new(2.0 * far + 2.0, 2.0, 2.0)]),
            alone,
            "{far}"
        );
    }
}

#[test]
fn rebuilding_reuses_memory_and_forgets_the_past() {
    let mut search = NeighborSearch::default();
    let mut list = NeighborList::default();
    let big = random_cloud(1, 80_000, 2);
    let small = random_cloud(2, 500, 3);
    search.within(Cloud::uniform(&big, 0.01), 0.0, &Periodic::NONE, &mut list).unwrap();
    let (first, memory) = (list.clone(), list.memory_bytes());
    let place = list.indices().as_ptr();
    search.within(Cloud::uniform(&small, 0.2), 0.0, &Periodic::NONE, &mut list).unwrap();
    check(&list, Cloud::uniform(&small, 0.2), None, 0.0, DVec3::ZERO);
    search.within(Cloud::uniform(&big, 0.01), 0.0, &Periodic::NONE, &mut list).unwrap();
    assert_eq!(list, first);
    assert_eq!((list.indices().as_ptr(), list.memory_bytes()), (place, memory));
}

#[test]
fn bad_input_is_named() {
    let failure = |cloud: Cloud<'_>, skin: f64, periodic: &Periodic| {
        let mut list = NeighborList::default();
        NeighborSearch::default().within(cloud, skin, periodic, &mut list).unwrap_err()
    };
    let points = [DVec3::ZERO, DVec3::X, DVec3::new(0.0, f64::NAN, 0.0)];
    let (good, bad) = (Cloud::uniform(&points[..2], 1.0), Cloud::uniform(&points, 1.0));
    let error = failure(bad, 0.0, &Periodic::NONE);
    assert!(matches!(error, NeighborError::Position { set: "target", index: 2, .. }), "{error}");
    for radii in [[1.0, 0.0], [1.0, -1.0], [1.0, f64::NAN], [1.0, f64::INFINITY]] {
        let error = failure(Cloud::per_particle(&points[..2], &radii), 0.0, &Periodic::NONE);
        assert!(matches!(error, NeighborError::SupportRadius { index: 1, .. }), "{error}");
    }
    let error = failure(Cloud::per_particle(&points[..2], &[1.0]), 0.0, &Periodic::NONE);
    assert_eq!(error, NeighborError::Length { set: "target", positions: 2, supports: 1 });
    assert_eq!(failure(good, -0.1, &Periodic::NONE), NeighborError::Skin(-0.1));
    let short = Periodic::new(DVec3::ZERO, DVec3::splat(2.1), [false, true, false]).unwrap();
    let error = failure(good, 0.1, &short);
    assert!(matches!(error, NeighborError::PeriodicTooShort { axis: 'y', .. }), "{error}");
    assert!(Periodic::new(DVec3::ONE, DVec3::ONE, [false, false, true]).is_err());
    assert!(Periodic::new(DVec3::ZERO, DVec3::splat(f64::NAN), [true, false, false]).is_err());
    let (mut search, mut list) = (NeighborSearch::default(), NeighborList::default());
    let error = search.between(good, bad, 0.0, &Periodic::NONE, &mut list).unwrap_err();
    assert!(matches!(error, NeighborError::Position { set: "source", index: 2, .. }), "{error}");
}

#[test]
fn verlet_list_holds_every_pair_until_it_is_rebuilt() {
    let torus = Periodic::new(DVec3::ZERO, DVec3::ONE, [true, false, false]).unwrap();
    let (support, skin) = (0.2, 0.05);
    let (mut fluid, solid) = (random_cloud(3, 150, 2), random_cloud(4, 80, 2));
    let mut random = Random(5);
    let velocity: Vec<DVec3> = fluid.iter().map(|_| random.point(2) - DVec3::splat(0.5)).collect();
    let (mut own, mut cross) = (VerletList::new(skin), VerletList::new(skin));
    for _ in 0..100 {
        for (x, v) in fluid.iter_mut().zip(&velocity) {
            *x = torus.wrap(*x + 0.004 * DVec3::new(v.x, v.y, 0.0));
        }
        let (targets, sources) = (Cloud::uniform(&fluid, support), Cloud::uniform(&solid, support));
        own.update(targets, None, &torus).unwrap();
        cross.update(targets, Some(sources), &torus).unwrap();
        for (list, others, same) in [(own.list(), &fluid, true), (cross.list(), &solid, false)] {
            for i in 0..fluid.len() {
                for j in 0..others.len() {
                    let near = distance_squared(fluid[i], others[j], torus.lengths()).sqrt() < support;
                    if near && !(same && i == j) {
                        assert!(list.row(i).contains(&(j as u32)), "pair {i} {j} is missing");
                    }
                }
            }
        }
    }
    assert!((3..60).contains(&own.builds()), "{} builds", own.builds());
    let mut again = VerletList::new(skin);
    let (targets, sources) = (own.built_targets().to_vec(), own.built_sources().to_vec());
    assert!(sources.is_empty());
    again.rebuild(Cloud::uniform(&targets, support), None, &torus).unwrap();
    assert_eq!(again.list(), own.list());
}

#[test]
fn verlet_list_is_stale_beyond_half_the_skin() {
    let mut points = random_cloud(9, 50, 3);
    let mut verlet = VerletList::new(0.1);
    assert!(verlet.is_stale(&points, None, &Periodic::NONE));
    let mut update = |points: &[DVec3]| verlet.update(Cloud::uniform(points, 0.3), None, &Periodic::NONE);
    assert_eq!(update(&points), Ok(true));
    points[17].y += 0.0499;
    assert_eq!(update(&points), Ok(false));
    points[17].y += 0.0002;
    assert_eq!(update(&points), Ok(true));
    assert_eq!(update(&points[..49]), Ok(true));
    points[3].z = f64::NAN;
    assert!(matches!(update(&points), Err(NeighborError::Position { index: 3, .. })));
    points[3].z = 0.0;
    assert_eq!(update(&points), Ok(true));
    verlet.invalidate();
    assert!(verlet.is_stale(&points, None, &Periodic::NONE));
}

#[test]
fn wrapped_positions_lie_in_the_box() {
    let torus = Periodic::new(DVec3::splat(-0.1), DVec3::splat(0.2), [true, false, true]).unwrap();
    for x in [-1e-18, -0.1, 0.2, 0.2 - 1e-17, 7.77, -123.4, 1e10] {
        let w = torus.wrap(DVec3::new(x, x, -0.1 - 1e-18));
        assert!((-0.1..0.2).contains(&w.x) && w.y == x && (-0.1..0.2).contains(&w.z), "{w}");
        let image = torus.minimal_image(DVec3::new(w.x - x, 0.0, 0.0));
        assert!(image.x.abs() <= 1e-15 * (1.0 + x.abs()), "{image}");
    }
}
