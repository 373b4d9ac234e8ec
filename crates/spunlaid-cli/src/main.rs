use spunlaid::air::*; use spunlaid::chain::*; use spunlaid::chain::schemes::*; use spunlaid::drag::*; use spunlaid::fibre::*; use spunlaid::lanes::*; use spunlaid::vec3::*; use spunlaid::ensemble::bundle::*;
fn main(){
  let fibre=Fibre{length:1.0,diameter:50e-6,density:950.,youngs_modulus:2e9,elements:20,root:Root::Pinned,direction:Vec3::new(1.,0.,0.)};
  let air=Air{velocity:10.,turbulence_intensity:0.1,length_scale:0.05,cutoff_frequency:100.,density:1.204,kinematic_viscosity:1.51e-5,harmonics:256};
  let drag=Drag{along:FrictionLaw::Matsui,across:NormalLaw::JuShambaugh,friction_coefficient:0.9};
  let s=Strand{fibre,drag:drag.of_element(&fibre,air.density,air.kinematic_viscosity),gravity:9.81,damping:0.};
  let eddies=Eddies::along(1.0,20,0.05);
  let lanes:Vec<_>=(0..8).map(|r|(air,StreamKey{seed:1,replicate:r})).collect();
  for isa in Isa::available(){ for scheme in [Scheme::SemiImplicitEuler,Scheme::Leapfrog]{
    let t=std::time::Instant::now();
    let turb=Turbulence::synthesise(isa,&lanes,eddies.count(),1.0);
    let ts=t.elapsed().as_secs_f64();
    let n:u64= if isa==Isa::Baseline {2000} else {1000_000}; 
    let mut b=Bundle::new(isa,&[s;8],&eddies,&turb,scheme,1e-6,0);
    let t=std::time::Instant::now();
    b.advance(n);
    let el=t.elapsed().as_secs_f64();
    let snap=b.snapshot();
    let m:Vec<_>=(0..8).map(|i|b.end_node().motion(i,1.0)).collect();
    let ay=m.iter().map(|m|m.amplitude_y).sum::<f64>()/8.;let az=m.iter().map(|m|m.amplitude_z).sum::<f64>()/8.;
    let f=m.iter().map(|m|m.frequency_y).sum::<f64>()/8.;
    let e=snap.energy;
    println!("{} {:?} synth {:.2} ms/fibre ns/el-step {:.2}  ay {:.3} az {:.3} mm f {:.1}  W-T/T {:e}  imb/Wd {:e} KE {:e} strain {:e}",isa.name(),scheme,ts*1e3/8.,el/(n as f64*20.*8.)*1e9,ay*1e3,az*1e3,f,(e.work.0[0]-e.kinetic.0[0])/e.kinetic.0[0],e.imbalance().0[0]/e.drag_work.0[0],e.kinetic.0[0],e.strain.0[0]);
    println!("{:x}", b.snapshot().position[20].y.0[3].to_bits());
  }}
}
