// Interfaces between media, which paths pass.

fn is_interface(material: u32) -> bool {
    return word(material_record(material)) == MaterialTag_Interface;
}

// Leads a ray that has hit an interface at distance `t` on, with its neighbours.
fn pass_through(ray: ptr<function, Ray>, near: ptr<function, Differentials>, s: Surface, t: f32) {
    (*near).rx_origin += (*near).rx_direction * t;
    (*near).ry_origin += (*near).ry_direction * t;
    *ray = spawn(s, (*ray).d);
}
