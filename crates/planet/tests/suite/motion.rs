//! Motion.

use alhazen_planet::{Input, Planet, State, Walker};
use lanes::InstructionSet;
use math::Vec3;
use sampling::Rng;

const STEP: f32 = 1.0 / 30.0;

#[test]
fn the_same_steps_give_the_same_bits_for_any_number_of_threads_and_lanes() {
    let run = |threads: usize, set: InstructionSet| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut planet = Planet::new(3000).with_instruction_set(set);
            let mut walker = Walker::new(&planet);
            let input = Input { forward: 1.0, runs: true, ..Input::default() };
            for step in 0..60 {
                if step == 15 {
                    let p = walker.center();
                    planet.blast(p, 3.0, 8.0);
                }
                walker.step(&planet, &input, STEP);
                planet.step(Some(walker.body()), STEP);
            }
            (planet.bodies().center.clone(), planet.moving(), walker.center())
        })
    };
    let one = run(1, InstructionSet::Scalar);
    assert!(one.1 > 100, "{} spheres move", one.1);
    assert_eq!(one, run(2, InstructionSet::detect()));
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        assert_eq!(one, run(3, set), "{set:?}");
    }
}

/// Balls that fall in a heap on one place of a core.
fn heap() -> Planet {
    let mut rng = Rng::from_sequence(5);
    let balls = (0..150).map(|_| {
        let [x, y, z, r] = [0; 4].map(|_| rng.uniform_f32());
        (Vec3::new(5.0 * x - 2.5, 5.0 * y - 2.5, 11.5 + 9.0 * z), 0.1 + 0.15 * r)
    });
    Planet::with_balls(10.0, balls)
}

#[test]
fn energy_does_not_grow_and_all_comes_to_rest() {
    let mut planet = heap();
    let begin = planet.energy();
    let mut least = begin.kinetic + begin.potential;
    for _ in 0..750 {
        planet.step(None, STEP);
        let energy = planet.energy();
        let sum = energy.kinetic + energy.potential;
        // The steps of falling bodies err, and separation lifts what has sunk in.
        assert!(sum < least + 0.004 * (begin.kinetic + begin.potential), "{sum} after {least}");
        least = least.min(sum);
    }
    assert!(planet.moving() < 4, "{} balls still move", planet.moving());
    assert!(least < 0.3 * begin.potential);
}

#[test]
fn no_sphere_sinks_deep_into_another() {
    let mut planet = heap();
    for step in 0..450 {
        planet.step(None, STEP);
        if step < 30 || step % 15 != 0 {
            continue;
        }
        // Of the smaller radius, while the heap falls and where it lies.
        let depth = if step < 300 { 0.5 } else { 0.2 };
        let bodies = planet.bodies();
        for i in 1..bodies.len() {
            let (p, r) = (bodies.center[i], bodies.radius[i]);
            assert!(p.length() > planet.radius() + (1.0 - depth) * r, "{i} in the core at step {step}");
            for j in i + 1..bodies.len() {
                let (q, s) = (bodies.center[j], bodies.radius[j]);
                let least = r + s - depth * r.min(s);
                assert!(p.distance(q) > least, "{i} and {j} at step {step}: {} {least}", p.distance(q));
            }
        }
    }
}

#[test]
fn balls_of_one_size_that_meet_exchange_momentum() {
    // Far from the core, so that up is the same for both.
    let balls = [(Vec3::new(0.0, 0.0, 20.0), 0.2), (Vec3::new(0.0, 0.0, 20.5), 0.2)];
    let mut planet = Planet::with_balls(1.0, balls);
    planet.step(None, STEP);
    planet.blast(Vec3::new(0.0, 0.0, 19.6), 0.4, 12.0);
    let sum = |planet: &Planet| planet.bodies().velocity.iter().fold(Vec3::ZERO, |sum, v| sum + *v);
    let before = sum(&planet);
    assert!(before.length() > 1.0);
    (0..6).for_each(|_| planet.step(None, STEP));
    let struck = planet.bodies().velocity[2];
    assert!(struck.z > 0.2 * before.z, "{struck:?}");
    // Gravity of 9 m/s² adds to both for a fifth of a second.
    let expected = before - Vec3::Z * 3.6;
    assert!(sum(&planet).distance(expected) < 1e-3 * before.length(), "{:?} {expected:?}", sum(&planet));
}

#[test]
fn a_walker_stands_walks_jumps_and_pushes() {
    let mut planet = Planet::new(6000);
    let mut walker = Walker::new(&planet);
    let step = |planet: &mut Planet, walker: &mut Walker, input: Input, steps: u32| {
        for _ in 0..steps {
            walker.step(planet, &input, STEP);
            planet.step(Some(walker.body()), STEP);
        }
    };
    step(&mut planet, &mut walker, Input::default(), 90);
    assert!(walker.stands());
    let at = walker.center();
    step(&mut planet, &mut walker, Input { forward: 1.0, ..Input::default() }, 60);
    assert!(walker.center().distance(at) > 1.5, "{}", walker.center().distance(at));
    let height = walker.center().length();
    step(&mut planet, &mut walker, Input { jumps: true, ..Input::default() }, 10);
    assert!(walker.center().length() > height + 0.5 || !walker.stands());
    assert!(walker.gaze(&planet).is_normalized() && walker.up(&planet).dot(walker.gaze(&planet)).abs() < 0.2);
    let is_finite = planet.bodies().center.iter().all(|center| center.is_finite());
    assert!(is_finite && planet.bodies().len() == 6000);
}

#[test]
fn most_of_the_land_rests_and_the_moon_keeps_balls_moving() {
    let mut planet = Planet::new(4000);
    for _ in 0..300 {
        planet.step(None, STEP);
    }
    let of = |state: State| planet.bodies().state.iter().filter(|other| **other == state).count();
    assert!(of(State::Held) > 500 && of(State::Resting) > 1000, "{} {}", of(State::Held), of(State::Resting));
    assert!(planet.moving() > 10, "{}", planet.moving());
    let highest = planet.bodies().center.iter().map(|center| center.length()).fold(0.0, f32::max);
    assert!(highest < 4.0 * planet.radius(), "{highest}");
}
